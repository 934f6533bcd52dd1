#pragma once

#include "core/types.hpp"

namespace fw::record {

/// Takes the frames of a trajectory one by one, in the order of time.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// Frame `time` [s] with the state y = (x, v). Throws SystemError (disk full).
  virtual void frame(double time, ConstVectorRef state) = 0;
};

}  // namespace fw::record
