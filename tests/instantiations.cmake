# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# The test cases of the library that run on several models of a warp. Each line compiles one header of
# test cases for one backend of support/backends/ and, if the header needs them, for some value types:
#   instantiate(HEADER BACKEND SET [TYPE...])
# SET is
#   quick  for every build of the tests: each header once on SIMD lanes and once on checked, and those
#          that use bits of lanes also on 64 lanes;
#   full   for WARPAGG_FULL_TESTS only: the other backends and value types.
# Sanitizers test the quick set: they leave out checked, and find no more in other types and widths.

instantiate(accumulators/accumulators.hpp checked quick)
# On 32 lanes they take four times as long.
instantiate(accumulators/accumulators.hpp narrow_lanes quick)
instantiate(accumulators/accumulators.hpp lanes full)
instantiate(accumulators/accumulators.hpp wide_checked full)
instantiate(accumulators/accumulators.hpp wide_lanes full)
instantiate(accumulators/accumulators.hpp serial full)
instantiate(accumulators/accumulators.hpp cuda quick)

instantiate(match_reduce_atomic/match_reduce_atomic.hpp checked quick float std::uint32_t)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp lanes quick float std::int32_t)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp narrow_lanes full float)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp wide_checked full float)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp wide_lanes quick std::uint32_t)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp wide_lanes full float std::int64_t)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp serial full float std::int32_t)
instantiate(match_reduce_atomic/match_reduce_atomic.hpp cuda quick float double std::int32_t std::uint64_t)

# lanes holds numbers only, so it has no aggregates, and sanitizers leave out checked.
instantiate(reduce_atomic/aggregates.hpp checked quick)
instantiate(reduce_atomic/aggregates.hpp wide_checked full)
instantiate(reduce_atomic/aggregates.hpp serial quick)
instantiate(reduce_atomic/aggregates.hpp cuda quick)

instantiate(reduce_atomic/commits.hpp checked quick float std::uint32_t)
instantiate(reduce_atomic/commits.hpp lanes quick float std::uint64_t)
instantiate(reduce_atomic/commits.hpp wide_checked full std::uint32_t)
instantiate(reduce_atomic/commits.hpp wide_lanes full float std::uint64_t)
instantiate(reduce_atomic/commits.hpp serial full float double std::int32_t)
instantiate(reduce_atomic/commits.hpp cuda quick float double std::int32_t)

instantiate(reduce_atomic/operations.hpp checked quick std::uint32_t std::int64_t)
instantiate(reduce_atomic/operations.hpp lanes quick std::int32_t std::uint32_t float)
instantiate(reduce_atomic/operations.hpp lanes full std::int64_t std::uint64_t)
instantiate(reduce_atomic/operations.hpp checked full float double)
instantiate(reduce_atomic/operations.hpp lanes full double)
instantiate(reduce_atomic/operations.hpp wide_checked full std::int32_t)
instantiate(reduce_atomic/operations.hpp wide_lanes full std::int32_t std::uint64_t float)
instantiate(reduce_atomic/operations.hpp serial full std::int32_t std::uint64_t float)
instantiate(reduce_atomic/operations.hpp cuda quick std::int32_t std::uint32_t float double)
instantiate(reduce_atomic/operations.hpp cuda full std::int64_t std::uint64_t)

instantiate(reduce_atomic/sums.hpp checked quick float)
instantiate(reduce_atomic/sums.hpp checked full double)
instantiate(reduce_atomic/sums.hpp checked full std::int32_t)
instantiate(reduce_atomic/sums.hpp checked full std::uint32_t)
instantiate(reduce_atomic/sums.hpp lanes quick float)
instantiate(reduce_atomic/sums.hpp lanes full double)
instantiate(reduce_atomic/sums.hpp lanes full std::int32_t)
instantiate(reduce_atomic/sums.hpp lanes full std::uint32_t)
instantiate(reduce_atomic/sums.hpp lanes full std::int64_t)
instantiate(reduce_atomic/sums.hpp narrow_lanes full float)
instantiate(reduce_atomic/sums.hpp wide_checked full float)
instantiate(reduce_atomic/sums.hpp wide_lanes full float)
instantiate(reduce_atomic/sums.hpp wide_lanes full double)
instantiate(reduce_atomic/sums.hpp wide_lanes full std::int32_t std::int64_t)
instantiate(reduce_atomic/sums.hpp serial full float double)
instantiate(reduce_atomic/sums.hpp serial full std::int32_t std::uint32_t)
instantiate(reduce_atomic/sums.hpp cuda quick float)
instantiate(reduce_atomic/sums.hpp cuda full double)
instantiate(reduce_atomic/sums.hpp cuda full std::int32_t)
instantiate(reduce_atomic/sums.hpp cuda full std::uint32_t)
instantiate(reduce_atomic/sums.hpp cuda full std::int64_t "long long" std::uint64_t)
instantiate(reduce_atomic/sums.hpp cuda full __half2 __nv_bfloat162)

# Its kernels take scalars, so they do not compile on lanes.
instantiate(scatter_rows/scatter_rows.hpp checked quick)
instantiate(scatter_rows/scatter_rows.hpp wide_checked full)
instantiate(scatter_rows/scatter_rows.hpp serial quick)
instantiate(scatter_rows/scatter_rows.hpp cuda quick)

instantiate(segmented_sum/segmented_sum.hpp checked quick)
instantiate(segmented_sum/segmented_sum.hpp lanes quick)
instantiate(segmented_sum/segmented_sum.hpp narrow_lanes full)
instantiate(segmented_sum/segmented_sum.hpp wide_checked full)
instantiate(segmented_sum/segmented_sum.hpp wide_lanes quick)
instantiate(segmented_sum/segmented_sum.hpp serial full)
instantiate(segmented_sum/segmented_sum.hpp cuda quick)

instantiate(warp/records.hpp checked quick)
instantiate(warp/records.hpp lanes quick)
instantiate(warp/records.hpp wide_checked full)
instantiate(warp/records.hpp wide_lanes full)
instantiate(warp/records.hpp serial full)
instantiate(warp/records.hpp cuda quick)
