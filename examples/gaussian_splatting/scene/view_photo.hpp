// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT
#pragma once

#include "scene.hpp"

namespace gs {

/// Decodes the photo of a streamed view, and replaces `result`, whose memory it reuses. Leaves out a
/// depth map that the view does not have anymore, because training does not use it.
inline void decode(const view& of, photo& result) {
    of.decode(result);
    if (!of.depths.is_there()) result.depths = {};
}

/// The photo of a view. It refers to the photo that the view holds, or decodes the photo of a
/// streamed view and owns it. The view must outlive the object.
class view_photo {
  public:
    explicit view_photo(const view& of) : view_(of) {
        if (of.is_streamed()) decode(of, decoded_);
    }
    view_photo(const view_photo&) = delete;
    view_photo& operator=(const view_photo&) = delete;

    const image& pixels() const { return view_.is_streamed() ? decoded_.pixels : view_.pixels; }
    const depth_map& depths() const { return view_.is_streamed() ? decoded_.depths : view_.depths; }

  private:
    const view& view_;
    photo decoded_;
};

}  // namespace gs
