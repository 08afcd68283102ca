// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#include "fault_log.hpp"

#include "../core/error.hpp"

namespace gs::train {

void fault_log::check(const fault_reports& found, const scene& scene, int iteration,
                      const std::function<void(const std::string&)>& warn) {
    const auto& loss = found[static_cast<std::size_t>(fault_kind::loss)];
    const auto& value = found[static_cast<std::size_t>(fault_kind::parameter)];
    const auto& gradient = found[static_cast<std::size_t>(fault_kind::gradient)];
    const auto& sum = found[static_cast<std::size_t>(fault_kind::sum)];
    const auto where = [&](const fault_report& f) {
        const std::size_t back = static_cast<std::size_t>(iteration - f.iteration) + 1;
        std::string text = "iteration " + std::to_string(f.iteration);
        for (const std::size_t view : views_[views_.size() - back])
            text += ", view " + scene.train[view].name;
        return text;
    };
    const auto parameter = [](const fault_report& f) {
        return std::string(parameter_names[static_cast<std::size_t>(f.parameter)]) + " of Gaussian " +
               std::to_string(f.gaussian);
    };
    if (gradient.count > 0 && left_out_gradients_ == 0)
        warn(where(gradient) + ": the gradient of " + parameter(gradient) +
             " is not finite or too large to square; such gradients are left out");
    if (sum.count > 0 && left_out_sums_ == 0)
        warn(where(sum) +
             ": a sum of gradients exceeds the range of its fixed-point number; such sums are left out");
    left_out_gradients_ += gradient.count;
    left_out_sums_ += sum.count;
    if (value.count > 0)
        throw error(where(value) + ": " + parameter(value) + " would not be finite; training ends here");
    if (loss.count > 0) throw error(where(loss) + ": the loss is not finite; training ends here");
    views_.clear();
}

}  // namespace gs::train
