// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "../core/error.hpp"
#include "../engine/engine.hpp"

namespace gs::train {

std::unique_ptr<engine> make_cuda_engine() { throw error("this program was built without CUDA"); }

int count_gpus() { return 0; }

std::string bus_id_of_gpu() { return ""; }

bool cuda_is_available(std::string& reason) {
    reason = "this program was built without CUDA";
    return false;
}

}  // namespace gs::train
