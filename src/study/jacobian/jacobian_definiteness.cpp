#include "study/jacobian/jacobian_definiteness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/theory/definiteness.hpp"
#include "core/special_values.hpp"
#include "study/jacobian/implicit_euler_equation.hpp"
#include "study/jacobian/jacobian_row.hpp"

namespace fw::study {

namespace {

/// Failed iterations in columns of counts.
constexpr std::int64_t failed = -1;

/// The predicted and the found limit agree to the rounding of both.
constexpr double limit_tolerance = 1e-6;

/// K and D, symmetric and with the rows and columns of fixed degrees of freedom zero.
struct Tangents {
  Matrix K, D;
};

Tangents tangents(const Ivp& ivp, TangentModel model) {
  const SecondOrderSystem& system = *ivp.system->second_order();
  const Index n = system.degrees_of_freedom();
  SparseMatrix K = system.tangent_pattern(), D = K;
  system.stiffness(ivp.t0, ivp.y0.head(n), ivp.y0.tail(n), model, K);
  system.damping(ivp.t0, ivp.y0.head(n), ivp.y0.tail(n), D);
  const auto symmetric = [&](const SparseMatrix& matrix) {
    Matrix dense(matrix);
    for (Index c = 0; c < n; ++c) {
      if (system.fixed()[static_cast<std::size_t>(c)] != 0) dense.col(c).setZero();
    }
    return Matrix(0.5 * (dense + dense.transpose()));
  };
  return {symmetric(K), symmetric(D)};
}

/// A at the initial state of `ivp`.
Matrix step_matrix(const Ivp& ivp, integrators::StepMatrix& assembly, double step, TangentModel model) {
  const Index n = ivp.system->second_order()->degrees_of_freedom();
  return assembly.assemble_symmetric(ivp.t0, ivp.y0.head(n), ivp.y0.tail(n), step, model);
}

/// The step from which A is indefinite, by bisection with Cholesky factorisations; NaN if A is definite still
/// at `top`.
double limit_step(const Ivp& ivp, integrators::StepMatrix& assembly, TangentModel model, double top) {
  const auto is_definite = [&](double step) {
    return analysis::is_positive_definite(step_matrix(ivp, assembly, step, model));
  };
  if (is_definite(top)) return no_value;
  double low = 0.0, high = top;
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (is_definite(middle) ? low : high) = middle;
  }
  return high;
}

struct IterationCount {
  std::int64_t iterations = failed;
  StatusCode code = StatusCode::success;
};

IterationCount newton(const Ivp& ivp, double step, TangentModel model, bool by_conjugate_gradients) {
  ImplicitEulerEquation equation(ivp, step, model, by_conjugate_gradients);
  const Index n = ivp.system->second_order()->degrees_of_freedom();
  linalg::Newton iteration(
      n, by_conjugate_gradients ? linalg::make_linear_solver({}) : linalg::default_direct_solver());
  Vector increment = Vector::Zero(n);
  Work work;
  const Status status = iteration.solve(equation, increment, 0.0, work);
  return {status.ok() ? static_cast<std::int64_t>(work.newton_iterations) : failed, status.code};
}

/// The system of the linearised step, A δ = h (f + h K v) [Zachmann 2011, S26], from a zero guess.
IterationCount conjugate_gradients(const Ivp& ivp, const Matrix& A, double step) {
  const SecondOrderSystem& system = *ivp.system->second_order();
  const Index n = system.degrees_of_freedom();
  const auto q = ivp.y0.head(n), v = ivp.y0.tail(n);
  const Vector zero = Vector::Zero(n);
  Vector force(n), product(n), increment = zero;
  system.force(ivp.t0, q, v, force);
  system.tangent_product(ivp.t0, q, v, v, zero, product);
  const auto solver = linalg::make_linear_solver({});
  Work work;
  if (Status status = solver->factorise(A.sparseView(), work); !status.ok()) return {failed, status.code};
  const linalg::LinearSolve solve = solver->solve(step * (force + step * product), increment, work);
  return {solve.status.ok() ? static_cast<std::int64_t>(solve.iterations) : failed, solve.status.code};
}

double mean_of_successes(const std::vector<std::int64_t>& counts) {
  double sum = 0.0, number = 0.0;
  for (const std::int64_t count : counts) {
    if (count == failed) continue;
    sum += static_cast<double>(count);
    number += 1.0;
  }
  return number > 0.0 ? sum / number : no_value;
}

double failures(const std::vector<std::int64_t>& counts) {
  return static_cast<double>(std::count(counts.begin(), counts.end(), failed));
}

class DefinitenessCase {
 public:
  DefinitenessCase(const StudyProblem& problem, std::string model, const DefinitenessSettings& settings,
                   const RunContext& context)
      : problem_(problem),
        name_(std::move(model)),
        model_(tangent_model(name_)),
        settings_(settings),
        context_(context) {}

  CaseResult run() {
    for (const double compression : settings_.compressions) look_at(compression);
    JacobianRow row{.subject = problem_.label, .part = "definiteness", .variant = name_};
    row.unknowns = problem_.problem.ivp.system->second_order()->degrees_of_freedom();
    row.samples = static_cast<std::int64_t>(eigenvalue_.size());
    row.smallest_eigenvalue = *std::min_element(eigenvalue_.begin(), eigenvalue_.end());
    row.indefinite = static_cast<double>(std::count_if(eigenvalue_.begin(), eigenvalue_.end(),
                                                       [](double e) { return e <= 0.0; })) /
                     static_cast<double>(eigenvalue_.size());
    row.limit_step = least(limit_);
    row.predicted_limit_step = least(predicted_);
    row.newton_iterations = mean_of_successes(newton_);
    row.newton_failures = failures(newton_);
    row.newton_cg_failures = failures(newton_cg_);
    row.cg_iterations = mean_of_successes(cg_);
    row.cg_failures = failures(cg_);
    CaseResult result;
    judge(row, result);
    add_columns(result);
    result.summary = cells_of(row);
    return result;
  }

 private:
  static double least(const std::vector<double>& limits) {
    double result = no_value;
    for (const double limit : limits) {
      if (!std::isnan(limit) && !(result <= limit)) result = limit;
    }
    return result;
  }

  void look_at(double compression) {
    Compression start = settings_.start;
    start.compression = compression;
    const Ivp ivp = compressed(problem_.problem.ivp, start);
    const SecondOrderSystem& system = *ivp.system->second_order();
    const Tangents tangent = tangents(ivp, model_);
    stiffness_eigenvalue_.push_back(analysis::smallest_eigenvalue(-tangent.K));
    length_ratio_.push_back(least_length_ratio(*ivp.system, ivp.y0));
    integrators::StepMatrix assembly(system);
    const double top = 100.0 * *std::max_element(settings_.steps.begin(), settings_.steps.end());
    limit_.push_back(limit_step(ivp, assembly, model_, top));
    predicted_.push_back(predict(tangent, system, top));
    check_limits();
    for (const double step : settings_.steps) {
      context_.check();
      const Matrix A = step_matrix(ivp, assembly, step, model_);
      eigenvalue_.push_back(analysis::smallest_eigenvalue(A));
      record(newton(ivp, step, model_, false), newton_, newton_status_);
      record(newton(ivp, step, model_, true), newton_cg_, newton_cg_status_);
      record(conjugate_gradients(ivp, A, step), cg_, cg_status_);
      const bool is_definite = std::isnan(limit_.back()) || step < (1.0 - limit_tolerance) * limit_.back();
      if (is_definite && cg_.back() == failed) ++wrong_failures_;
    }
  }

  /// psd_projection is definite by construction; of the others the spectrum tells.
  double predict(const Tangents& tangent, const SecondOrderSystem& system, double top) const {
    if (model_ == TangentModel::psd_projection) return no_value;
    const double rate = analysis::fastest_growth_rate(tangent.K, tangent.D, system.mass());
    return rate > 1.0 / top ? 1.0 / rate : no_value;
  }

  void check_limits() {
    const double found = limit_.back(), predicted = predicted_.back();
    if (std::isnan(found) && std::isnan(predicted)) return;
    const double difference = std::abs(found / predicted - 1.0);
    if (difference <= limit_tolerance) {
      largest_difference_ = std::max(largest_difference_, difference);
    } else {
      ++wrong_limits_;
    }
  }

  static void record(const IterationCount& count, std::vector<std::int64_t>& iterations,
                     std::vector<std::string>& statuses) {
    iterations.push_back(count.iterations);
    statuses.emplace_back(to_string(count.code));
  }

  void judge(const JacobianRow& row, CaseResult& result) const {
    result.verdict = wrong_limits_ == 0 && wrong_failures_ == 0 ? Verdict::holds : Verdict::fails;
    const std::string definite =
        std::isnan(row.predicted_limit_step)
            ? fmt::format(
                  "A is positive definite at every step, as predicted (smallest eigenvalue {:.3g} kg)",
                  row.smallest_eigenvalue)
            : fmt::format("A is indefinite from h = {:.4g} s on, where the spectrum predicts it to {:.0e}",
                          row.limit_step, std::max(largest_difference_, 1e-16));
    const std::string wrong = fmt::format(
        "{} of {} limits are not as predicted (least found {:.4g} s, predicted {:.4g} s), {} failures of "
        "conjugate gradients where A is definite",
        wrong_limits_, limit_.size(), row.limit_step, row.predicted_limit_step, wrong_failures_);
    result.reason = fmt::format(
        "{}; of {} points Newton fails at {} (at {} with CG), CG fails at {}; {:.3g} "
        "Newton and {:.3g} CG iterations on average",
        result.verdict == Verdict::holds ? definite : wrong, row.samples, row.newton_failures,
        row.newton_cg_failures, row.cg_failures, row.newton_iterations, row.cg_iterations);
  }

  void add_columns(CaseResult& result) {
    const std::vector<std::uint64_t> grid = {settings_.compressions.size(), settings_.steps.size()};
    result.columns = {{"compression", "1", settings_.compressions, {}, {}},
                      {"length_ratio", "1", length_ratio_, {}, {}},
                      {"stiffness_eigenvalue", "N/m", stiffness_eigenvalue_, {}, {}},
                      {"limit_step", "s", limit_, {}, {}},
                      {"predicted_limit_step", "s", predicted_, {}, {}},
                      {"step", "s", settings_.steps, {}, {}},
                      {"eigenvalue", "kg", eigenvalue_, grid, {}},
                      {"newton_iterations", "1", newton_, grid, {}},
                      {"newton_status", "", newton_status_, grid, {}},
                      {"newton_cg_iterations", "1", newton_cg_, grid, {}},
                      {"newton_cg_status", "", newton_cg_status_, grid, {}},
                      {"cg_iterations", "1", cg_, grid, {}},
                      {"cg_status", "", cg_status_, grid, {}}};
  }

  const StudyProblem& problem_;
  std::string name_;
  TangentModel model_;
  const DefinitenessSettings& settings_;
  const RunContext& context_;
  std::vector<double> stiffness_eigenvalue_, length_ratio_, limit_, predicted_, eigenvalue_;
  std::vector<std::int64_t> newton_, newton_cg_, cg_;
  std::vector<std::string> newton_status_, newton_cg_status_, cg_status_;
  double largest_difference_ = 0.0;
  int wrong_limits_ = 0, wrong_failures_ = 0;
};

}  // namespace

const std::vector<std::string>& tangent_model_names() {
  static const std::vector<std::string> list = {"exact", "tensile_geometric_term", "psd_projection"};
  return list;
}

TangentModel tangent_model(const std::string& name) {
  if (name == "psd_projection") return TangentModel::psd_projection;
  return name == "tensile_geometric_term" ? TangentModel::tensile_geometric_term : TangentModel::exact;
}

CaseResult run_definiteness(const StudyProblem& problem, const std::string& model,
                            const DefinitenessSettings& settings, const RunContext& context) {
  return DefinitenessCase(problem, model, settings, context).run();
}

}  // namespace fw::study
