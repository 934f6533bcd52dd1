#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "linalg/petsc_call.hpp"

namespace fw::linalg {
namespace {

using testing::HasSubstr;

TEST(PetscOptions, RefusesThoseThatPrintOrTouchFilesByName) {
  for (const std::string text :
       {"-help", "-help intro", "-options_file /dev/zero", "-options_view", "-ksp_monitor",
        "-ksp_view ascii:foo.txt", "-mat_view binary:foo", "-ts_monitor_solution ascii:foo.txt",
        "-mg_levels_ksp_monitor_true_residual", "-ksp_converged_reason", "-log_view", "-info",
        "-start_in_debugger", "-snes_test_jacobian", "-ts_save_trajectory", "-malloc_dump",
        "-ksp_compute_eigenvalues"}) {
    const std::string message = message_of([&] { make_linear_solver(petsc("-pc_type jacobi " + text)); });
    EXPECT_THAT(message, HasSubstr(text.substr(0, text.find(' ')) + " prints, writes or reads files"))
        << text;
  }
  EXPECT_NO_THROW(make_linear_solver(petsc("-ksp_type chebyshev -ksp_chebyshev_eigenvalues 0.1,1.1")));
}

}  // namespace
}  // namespace fw::linalg
