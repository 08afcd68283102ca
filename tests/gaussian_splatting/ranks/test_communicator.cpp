// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "../../support/temporary_folder.hpp"
#include "ranks/communicator.hpp"
#include "ranks/own_share.hpp"
#include "ranks/run.hpp"

namespace {

using gs::ranks::communicator;
using gs_test::says;

/// The end of ranks that return whether they found what they expected.
bool all_find(int count, const std::function<bool(communicator&)>& expected) {
    const auto end = gs::ranks::run(count, [&](communicator& all) {
        if (!expected(all)) throw std::runtime_error("something else");
        return 0;
    });
    return end.code == 0 && end.reason.empty();
}

double seconds_of(const std::function<void()>& action) {
    const auto start = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

TEST_CASE("communicator: a process alone is the first and only rank, and keeps its values") {
    communicator alone;
    CHECK(alone.is_first());
    CHECK(alone.count() == 1);
    double value = 3;
    alone.sum(&value, 1);
    alone.barrier();
    CHECK(value == 3);
    CHECK(alone.from_first(4) == 4);
    CHECK(alone.any(true));
    CHECK_FALSE(alone.any(false));
}

TEST_CASE("communicator: all ranks get the sums, the extremes and the value of the first rank") {
    for (const int count : {2, 3, 5}) {
        CAPTURE(count);
        CHECK(all_find(count, [&](communicator& all) {
            std::vector<std::int64_t> sums{all.rank(), -10 * all.rank(), std::int64_t{1} << 60};
            all.sum(sums.data(), 2);
            std::uint64_t least = static_cast<std::uint64_t>(all.rank() + 3), most = least;
            all.minimum(&least, 1);
            all.maximum(&most, 1);
            all.sum(sums.data(), 0);
            const int expected = count * (count - 1) / 2;
            return all.count() == count && sums[0] == expected && sums[1] == -10 * expected && least == 3 &&
                   most == static_cast<std::uint64_t>(count + 2) && all.from_first(all.rank() + 0.5) == 0.5 &&
                   all.any(all.rank() == count - 1) && !all.any(false);
        }));
    }
}

TEST_CASE("communicator: sums of floats are added in the order of ranks") {
    // (1 + 2^-24) + 2^-24 is 1 in floats, and any other order yields more.
    CHECK(all_find(3, [](communicator& all) {
        float value = all.is_first() ? 1.0f : 0x1p-24f;
        all.sum(&value, 1);
        return value == 1.0f;
    }));
    CHECK(all_find(3, [](communicator& all) {
        float value = all.rank() == 2 ? 1.0f : 0x1p-24f;
        all.sum(&value, 1);
        return value == 1.0f + 0x1p-23f;
    }));
}

TEST_CASE("communicator: values that take several slots are exchanged in parts") {
    CHECK(all_find(2, [](communicator& all) {
        std::vector<double> values(300'001);
        for (int round = 1; round < 4; ++round) {
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] = static_cast<double>(i) * (all.rank() + round);
            all.sum(values.data(), values.size());
            for (std::size_t i = 0; i < values.size(); ++i)
                if (values[i] != static_cast<double>(i) * (2 * round + 1)) return false;
        }
        return true;
    }));
}

TEST_CASE("communicator: all ranks get the parts of the others") {
    for (const int count : {2, 3, 5})
        for (const std::size_t items : {0u, 40u, 1'000'000u}) {
            CAPTURE(count);
            CAPTURE(items);
            CHECK(all_find(count, [&](communicator& all) {
                const gs::ranks::shares shares(items, 32, count);
                std::vector<std::uint64_t> values(items);
                const auto own = shares.of(all.rank());
                for (int round = 1; round < 3; ++round) {
                    for (std::size_t i = own.first; i < own.last; ++i)
                        values[i] = i * static_cast<std::size_t>(round);
                    const gs::ranks::shared_array array[] = {
                        gs::ranks::shared_array::of(values.data(), 32, items)};
                    all.gather(shares, array);
                    for (std::size_t i = 0; i < items; ++i)
                        if (values[i] != i * static_cast<std::size_t>(round)) return false;
                    all.barrier();
                }
                return true;
            }));
        }
}

TEST_CASE("communicator: each rank gets the windows that the others send to it, and can send them back") {
    for (const int count : {2, 3, 5})
        for (const std::size_t size : {1u, 60'000u}) {  // 60,000 items of 3 doubles take several slots
            CAPTURE(count);
            CAPTURE(size);
            CHECK(all_find(count, [&](communicator& all) {
                // Rank 1 sends nothing to rank 0.
                std::vector<std::size_t> counts;
                for (int i = 0; i < count * count; ++i)
                    counts.push_back(i == count ? 0 : size * static_cast<std::size_t>(i % 4 + 1));
                const gs::ranks::windows windows(counts, count);
                const auto value = [](int from, int to, std::size_t i) {
                    return 1e7 * from + 1e6 * to + static_cast<double>(i);
                };
                const int me = all.rank();
                const auto& to = windows.sent_by(me);
                const auto& from = windows.received_by(me);
                std::vector<double> sent(3 * to.items()), received(3 * from.items(), -1),
                    back(sent.size(), -1);
                for (int r = 0; r < count; ++r)
                    for (std::size_t i = 0; i < 3 * to.of(r).count(); ++i)
                        sent[3 * to.of(r).first + i] = value(me, r, i);
                const auto array = [](const auto& a, auto& b) {
                    return gs::ranks::window_array::of(a.data(), b.data(), 3);
                };
                all.exchange(windows, std::array{array(sent, received)});
                all.exchange(windows.reversed(), std::array{array(received, back)});
                for (int r = 0; r < count; ++r) {
                    for (std::size_t i = 0; i < 3 * from.of(r).count(); ++i)
                        if (received[3 * from.of(r).first + i] != (r == me ? -1 : value(r, me, i)))
                            return false;
                    for (std::size_t i = 0; i < 3 * to.of(r).count(); ++i)
                        if (back[3 * to.of(r).first + i] != (r == me ? -1 : value(me, r, i))) return false;
                }
                return true;
            }));
        }
}

TEST_CASE("ranks: those on the same processors share the threads") {
    CHECK(all_find(5, [](communicator& all) {
        const std::uint64_t processors[] = {7, 9, 7, 7, 8};
        const int threads[] = {8, 3, 8, 8, 1}, expected[] = {3, 3, 3, 2, 1};
        const auto rank = static_cast<std::size_t>(all.rank());
        return gs::ranks::own_threads(all, threads[rank], processors[rank]) == expected[rank];
    }));
    CHECK(all_find(3, [](communicator& all) { return gs::ranks::own_threads(all, 2, 0) == 1; }));
}

TEST_CASE("ranks: all learn which one has no device for itself") {
    const auto find = [](const std::vector<std::uint64_t>& devices, int expected) {
        return all_find(3, [&](communicator& all) {
            return gs::ranks::first_without_device(all, devices[static_cast<std::size_t>(all.rank())]) ==
                   expected;
        });
    };
    CHECK(find({4, 5, 6}, 3));
    CHECK(find({4, 5, 4}, 2));
    CHECK(find({4, 0, 4}, 1));
    CHECK(find({0, 0, 0}, 0));
}

TEST_CASE("communicator: ranks that disagree about an exchange end with an error") {
    for (const bool other_size : {false, true}) {
        const auto end = gs::ranks::run(2, [&](communicator& all) {
            std::vector<double> values(2);
            const bool differs = !all.is_first();
            if (differs && !other_size) {
                std::int64_t whole[2]{};
                all.sum(whole, 2);
            } else {
                all.sum(values.data(), differs ? 1u : 2u);
            }
            return 0;
        });
        CHECK(end.code != 0);
        CHECK(says(end.reason, {"disagree"}));
    }
}

TEST_CASE("ranks: the first one's exit code is the result") {
    const auto end = gs::ranks::run(3, [](communicator& all) { return all.is_first() ? 7 : 0; });
    CHECK(end.code == 7);
    CHECK(end.reason == "");
}

TEST_CASE("ranks: a rank that does not end after the first one has succeeded is killed without an error") {
    gs::ranks::outcome end;
    CHECK(seconds_of([&] {
              end = gs::ranks::run(2, [](communicator& all) {
                  if (!all.is_first()) sleep(100);
                  return 0;
              });
          }) < 20);
    CHECK(end.code == 0);
    CHECK(end.reason == "");
}

TEST_CASE("ranks: a rank that fails or is killed is named, and ends the others in bounded time") {
    const auto wait_for_others = [](communicator& all) {
        for (;;) all.barrier();
        return 0;
    };
    gs::ranks::outcome end;
    CHECK(seconds_of([&] {
              end = gs::ranks::run(3, [&](communicator& all) {
                  all.barrier();
                  if (all.rank() == 1) std::raise(SIGKILL);
                  return wait_for_others(all);
              });
          }) < 4);
    CHECK(says(end.reason, {"rank 1 of 3", "killed by signal 9"}));
    CHECK(end.code != 0);

    end = gs::ranks::run(3, [&](communicator& all) {
        all.barrier();
        if (all.rank() == 2) throw std::runtime_error("no more photos");
        return wait_for_others(all);
    });
    CHECK(says(end.reason, {"rank 2 of 3", "no more photos"}));

    // The others are not in a collective function.
    CHECK(seconds_of([&] {
              end = gs::ranks::run(2, [&](communicator& all) {
                  if (all.rank() == 0) std::raise(SIGKILL);
                  for (;;) sleep(100);
                  return 0;
              });
          }) < 20);
    CHECK(says(end.reason, {"rank 0 of 2", "killed by signal 9"}));
}
