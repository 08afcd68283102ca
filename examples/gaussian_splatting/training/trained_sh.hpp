// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "../engine/sh_degree_state.hpp"
#include "../features/sh_degree/prune_sh.hpp"

namespace gs::train {

/// The SH degree of an engine's model, and the SH coefficients of the parameters and of Adam's moments. It is
/// a friend of the engine.
template <class Engine>
class trained_sh final : public sh_degree_state {
  public:
    explicit trained_sh(Engine& on) : on_(on) {}
    void set_degree(int degree) override {
        on_.trained_.change_sh_degree(on_.device_, on_.sh_degree_, degree);
        on_.sh_degree_ = degree;
    }
    std::size_t prune(double change) override {
        if (on_.count_ > 0 && on_.sh_degree_ > 0) {
            on_.division_.update();
            on_.trained_.require_memory(on_.device_, on_.count_, on_.sh_degree_);
            auto views = on_.drawn(on_.views_.smallest());
            sh_pruner(on_.device_, on_.gather_).run(on_.trained_, on_.count_, on_.sh_degree_, views, change);
            on_.begin_generation(on_.count_);
        }
        return on_.trained_.values.gaussians_with_sh();
    }

  private:
    Engine& on_;
};

}  // namespace gs::train
