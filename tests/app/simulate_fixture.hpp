#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "app/process.hpp"
#include "store/scratch_directory.hpp"

namespace fw::app::test {

using Words = std::vector<std::string>;

/// A fixed point, a damped spring and a moving point in a field of gravity.
inline const std::string pendulum = R"(title = "pendulum"
[world]
gravity = [0, 0, -9.81]
[particles]
position = [[0.1, 0.2, 0.3], [1, 0, 0], [1.5, 0.5, 0]]
velocity = [[0, 0, 0], [0, 1, 0], [0, 0, 1]]
mass = [1, 2, 3]
fixed = [0]
[springs]
between = [[0, 1], [1, 2]]
stiffness = [100, 80]
damping = 0.1
)";

/// Runs of `federwerk simulate` on the pendulum, in a directory of their own.
class Simulate : public ::testing::Test {
 protected:
  void SetUp() override { store::test::write_bytes(scratch_ / "s.toml", pendulum); }

  std::string file(const std::string& name) const { return (scratch_ / name).string(); }

  /// Simulates with these further arguments into `output`; the result of the process.
  ProcessResult simulate(const std::string& output, const Words& arguments) const {
    Words all{"simulate", "s.toml", "-o", output};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(scratch_.path(), all);
  }

  store::test::ScratchDirectory scratch_;
};

}  // namespace fw::app::test
