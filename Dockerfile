# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# The trainer in a container, on a GPU or on the CPU:
#   docker build -t gaussian_splatting .
#   docker run --rm --gpus all -v "$PWD:/data" gaussian_splatting train -d SCENE -o OUTPUT
FROM nvidia/cuda:13.0.0-devel-ubuntu24.04 AS build
WORKDIR /warpagg
COPY . .
RUN scripts/setup.sh dpkg-dev file && cmake --workflow --preset package

# The program contains the CUDA runtime, and the host provides the driver. An image of CUDA would
# refuse hosts with older drivers, on which the program uses the CPU.
FROM ubuntu:24.04
COPY --from=build /warpagg/build/package/warpagg-gaussian-splatting_*.deb /tmp/
RUN apt-get update -q \
    && apt-get install -qy --no-install-recommends /tmp/*.deb \
    && rm -rf /tmp/*.deb /var/lib/apt/lists/*
ENV NVIDIA_VISIBLE_DEVICES=all NVIDIA_DRIVER_CAPABILITIES=compute,utility
USER ubuntu
WORKDIR /data
ENTRYPOINT ["gaussian_splatting"]
CMD ["--help"]
