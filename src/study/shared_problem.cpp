#include "study/shared_problem.hpp"

#include "analysis/reference_cache.hpp"

namespace fw::study {

const analysis::ReferenceSolution& SharedProblem::reference(const RunContext& context) const {
  std::call_once(once_, [&] {
    const double end[] = {ivp().t1};
    reference_ =
        problem_.problem.exact
            ? analysis::reference(problem_.problem, end)
            : analysis::ReferenceCache(context.reference_cache).certified(problem_.identity, ivp(), end);
  });
  return reference_;
}

}  // namespace fw::study
