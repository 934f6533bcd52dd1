#pragma once

#include <mutex>

#include "analysis/reference_solution.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// A problem that several cases share, with its end state in closed form or as a certified reference, which
/// the first case to need it computes for all. Safe to use from several threads.
class SharedProblem {
 public:
  explicit SharedProblem(StudyProblem problem) : problem_(std::move(problem)) {}

  const StudyProblem& entry() const { return problem_; }
  const Ivp& ivp() const { return problem_.problem.ivp; }

  /// At `ivp().t1`; its status says whether there is one.
  const analysis::ReferenceSolution& reference(const RunContext& context) const;

 private:
  StudyProblem problem_;
  mutable std::once_flag once_;
  mutable analysis::ReferenceSolution reference_;
};

}  // namespace fw::study
