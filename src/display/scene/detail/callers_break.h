#pragma once

#include <functional>

#include "scene/detail/surface_layer.h"

namespace trocar::scene::detail {

/// Polls the caller of `render`; once it returns true, this stays true until the end of the frame.
class CallersBreak : public FrameBreak {
 public:
  bool is_wanted() override {
    if (!has_broken_ && wants_break_ && *wants_break_ && (*wants_break_)()) has_broken_ = true;
    return has_broken_;
  }
  void begin(const std::function<bool()>& wants_break) {
    wants_break_ = &wants_break;
    has_broken_ = false;
  }
  void end() noexcept { wants_break_ = nullptr; }
  bool has_broken() const noexcept { return has_broken_; }

 private:
  const std::function<bool()>* wants_break_ = nullptr;
  bool has_broken_ = false;
};

}  // namespace trocar::scene::detail
