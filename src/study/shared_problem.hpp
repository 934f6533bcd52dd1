#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "analysis/reference/reference_solution.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// In which arithmetic a reference without closed form is computed.
enum class ReferenceArithmetic {
  binary128,  ///< certified, about 19 digits
  binary64,   ///< by two methods in double, about 9 digits: for systems too large for the other
};

/// "binary128", "binary64".
std::string to_string(ReferenceArithmetic arithmetic);
/// The key `reference`, which chooses it by these names.
settings::Setting reference_setting(ReferenceArithmetic& arithmetic);
/// The same for kinds that had no such key once: a file that does not give it has the same resolved text as then.
settings::Setting reference_setting(std::optional<ReferenceArithmetic>& arithmetic);

/// A problem that several cases share, with its end state in closed form or as a certified reference, which
/// the first case to need it computes for all. Safe to use from several threads.
class SharedProblem {
 public:
  explicit SharedProblem(StudyProblem problem,
                         ReferenceArithmetic arithmetic = ReferenceArithmetic::binary128)
      : problem_(std::move(problem)), arithmetic_(arithmetic) {}

  const StudyProblem& entry() const { return problem_; }
  const Ivp& ivp() const { return problem_.problem.ivp; }

  /// At `ivp().t1`; its status says whether there is one.
  const analysis::ReferenceSolution& reference(const RunContext& context) const;

 private:
  StudyProblem problem_;
  ReferenceArithmetic arithmetic_;
  mutable std::once_flag once_;
  mutable analysis::ReferenceSolution reference_;
};

}  // namespace fw::study
