#include "oracles/petsc/time_steppers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "oracles/petsc/ts_stepper.hpp"
#include "text/closest_name.hpp"

namespace fw::oracles {

using linalg::petsc_check;

namespace {

const TsType& find_type(const std::vector<TsType>& types, const std::string& name) {
  std::vector<std::string> names;
  std::string list;
  for (const TsType& type : types) {
    if (type.name == name) return type;
    names.push_back(type.name);
    list += (list.empty() ? "" : ", ") + type.name;
  }
  throw InputError(
      fmt::format("option type: found \"{}\"{}, expected one of {}", name, did_you_mean(name, names), list));
}

MethodInfo info_of(const std::string& name, const std::string& title, int order) {
  return {.name = "petsc:" + name,
          .title = title,
          .family = "oracle",
          .order = order,
          .order_with_velocity_forces = order,
          .stages = 1,
          .is_explicit = false,
          .is_adaptive = true,
          .has_fixed_step = true,
          .dense_output = DenseOutput::side_steps,
          .reference = "[Abhyankar et al. 2018]"};
}

std::unique_ptr<Integrator> make(MethodInfo info, TsMethod method, ToleranceScaling scaling = {}) {
  method.order = std::max(info.order, 1);
  linalg::check_petsc_options(method.petsc_options);
  return std::make_unique<OracleIntegrator>(
      std::move(info),
      [method](const Ivp& ivp, const StepControl& control, Work& work) {
        return std::make_unique<TsStepper>(method, ivp, control, work);
      },
      scaling);
}

}  // namespace

const std::vector<TsType>& ts_rk_types() {
  static const std::vector<TsType> types = {{"1fe", 1, 1}, {"2a", 2, 2},  {"2b", 2, 2},   {"3", 3, 3},
                                            {"3bs", 3, 3}, {"4", 4, 4},   {"5f", 5, 6},   {"5dp", 5, 6},
                                            {"5bs", 5, 7}, {"6vr", 6, 8}, {"7vr", 7, 10}, {"8vr", 8, 13}};
  return types;
}

std::unique_ptr<Integrator> make_ts_rk(const TsRkOptions& options) {
  const TsType& type = find_type(ts_rk_types(), options.type);
  MethodInfo info = info_of("ts_rk", fmt::format("PETSc TS, explicit Runge-Kutta {}", type.name), type.order);
  info.is_explicit = true;
  info.stages = type.stages;
  // The others have no embedded solution.
  info.is_adaptive = type.name != "1fe" && type.name != "2b" && type.name != "3" && type.name != "4";
  info.formula = "k_i = f(t + c_i h, y + h sum_j a_ij k_j), y1 = y + h sum_i b_i k_i";
  return make(std::move(info),
              {.type = TSRK,
               .form = TsForm::explicit_form,
               .configure = [name = type.name](TS ts) { petsc_check(TSRKSetType(ts, name.c_str())); },
               .petsc_options = options.petsc});
}

std::unique_ptr<Integrator> make_ts_theta(const TsThetaOptions& options) {
  if (!(options.theta > 0.0) || !(options.theta <= 1.0)) {
    throw InputError(fmt::format("option theta: found {}, expected 0 < theta <= 1", options.theta));
  }
  MethodInfo info = info_of("ts_theta", "PETSc TS, theta method", options.theta == 0.5 ? 2 : 1);
  info.formula = options.endpoint ? "y1 = y + h ((1 - theta) f(t, y) + theta f(t + h, y1))"
                                  : "y1 = y + h f(t + theta h, y + theta (y1 - y))";
  info.is_a_stable = options.theta >= 0.5;
  info.is_l_stable = options.theta == 1.0;
  info.is_symmetric = options.theta == 0.5;
  info.is_symplectic = options.theta == 0.5 && !options.endpoint;  // the midpoint rule
  return make(std::move(info),
              {.type = TSTHETA,
               .form = TsForm::implicit_form,
               .configure =
                   [options](TS ts) {
                     petsc_check(TSThetaSetTheta(ts, options.theta));
                     petsc_check(TSThetaSetEndpoint(ts, options.endpoint ? PETSC_TRUE : PETSC_FALSE));
                   },
               .petsc_options = options.petsc});
}

std::unique_ptr<Integrator> make_ts_bdf(const TsBdfOptions& options) {
  if (options.order < 1 || options.order > 6) {
    throw InputError(fmt::format("option order: found {}, expected 1 to 6", options.order));
  }
  // PETSc starts with two implicit Euler steps of half the size and raises the order from there: with
  // constant steps the start leaves an error of second order.
  MethodInfo info = info_of("ts_bdf", fmt::format("PETSc TS, backward differentiation {}", options.order),
                            std::min(options.order, 2));
  info.formula = "sum_j alpha_j y_(n+1-j) = h f(t_(n+1), y_(n+1)) on variable steps";
  info.is_multistep = true;
  info.dense_output = DenseOutput::library;
  info.is_a_stable = info.is_l_stable = options.order <= 2;
  return make(std::move(info),
              {.type = TSBDF,
               .form = TsForm::implicit_form,
               .configure = [order = options.order](TS ts) { petsc_check(TSBDFSetOrder(ts, order)); },
               .petsc_options = options.petsc},
              {.factor = options.tolerance_factor});
}

const std::vector<TsType>& ts_arkimex_types() {
  static const std::vector<TsType> types = {{"1bee", 1},   {"a2", 2}, {"l2", 2}, {"ars122", 2},
                                            {"2c", 2},     {"2d", 2}, {"2e", 2}, {"3", 3},
                                            {"ars443", 3}, {"4", 4},  {"5", 5}};
  return types;
}

std::unique_ptr<Integrator> make_ts_arkimex(const TsArkimexOptions& options) {
  const TsType& type = find_type(ts_arkimex_types(), options.type);
  MethodInfo info = info_of("ts_arkimex",
                            fmt::format("PETSc TS, additive Runge-Kutta {}{}", type.name,
                                        options.splitting ? ", stiff springs implicit" : ""),
                            type.order);
  if (options.splitting) info.needs = {Capability::second_order, Capability::force_splitting};
  info.is_adaptive = type.name != "ars443";
  info.formula = "y1 = y + h sum_i (b_i f_stiff(Y_i) + b^_i f_soft(Y_i)), f_stiff implicit";
  return make(std::move(info),
              {.type = TSARKIMEX,
               .form = options.splitting ? TsForm::implicit_explicit : TsForm::implicit_form,
               .configure =
                   [options](TS ts) {
                     petsc_check(TSARKIMEXSetType(ts, options.type.c_str()));
                     petsc_check(TSARKIMEXSetFullyImplicit(ts, options.splitting ? PETSC_FALSE : PETSC_TRUE));
                   },
               .petsc_options = options.petsc});
}

const std::vector<TsType>& ts_rosw_types() {
  static const std::vector<TsType> types = {{"2m", 2},     {"2p", 2},     {"ra3pw", 3}, {"ra34pw2", 3},
                                            {"rodas3", 3}, {"sandu3", 3}, {"grk4t", 4}, {"shamp4", 4},
                                            {"veldd4", 4}, {"4l", 4}};
  return types;
}

std::unique_ptr<Integrator> make_ts_rosw(const TsRoswOptions& options) {
  const TsType& type = find_type(ts_rosw_types(), options.type);
  MethodInfo info = info_of("ts_rosw", fmt::format("PETSc TS, Rosenbrock-W {}", type.name), type.order);
  return make(std::move(info),
              {.type = TSROSW,
               .form = TsForm::autonomous,
               .configure = [name = type.name](TS ts) { petsc_check(TSRosWSetType(ts, name.c_str())); },
               .petsc_options = options.petsc});
}

std::unique_ptr<Integrator> make_ts_alpha2(const TsAlpha2Options& options) {
  if (!(options.rho_infinity >= 0.0) || !(options.rho_infinity <= 1.0)) {
    throw InputError(fmt::format("option rho_infinity: found {}, expected 0 to 1", options.rho_infinity));
  }
  // PETSc 3.18 starts from twice the acceleration, which leaves an error of first order unless the scheme
  // does not depend on it (a spectral radius of 1).
  MethodInfo info = info_of("ts_alpha2", "PETSc TS, generalised-alpha of second-order systems",
                            options.rho_infinity == 1.0 ? 2 : 1);
  info.formula = "M a_(n+alpha_m) = f(t_(n+alpha_f), q_(n+alpha_f), v_(n+alpha_f)), Newmark's q and v";
  info.needs = {Capability::second_order};
  info.carries_more_than_state = true;
  info.dense_output = DenseOutput::cubic_hermite;  // a side step would start from the wrong acceleration
  info.is_a_stable = true;
  info.is_l_stable = options.rho_infinity == 0.0;
  info.is_symplectic = info.is_symmetric = options.rho_infinity == 1.0;  // alpha_m = alpha_f = 1/2: midpoint
  info.reference = "[Chung, Hulbert 1993; Abhyankar et al. 2018]";
  return make(std::move(info),
              {.type = TSALPHA2,
               .form = TsForm::second_order,
               .configure = [rho = options.rho_infinity](TS ts) { petsc_check(TSAlpha2SetRadius(ts, rho)); },
               .petsc_options = options.petsc});
}

std::unique_ptr<Integrator> make_ts_basicsymplectic(const TsBasicSymplecticOptions& options) {
  if (options.order < 1 || options.order > 4) {
    throw InputError(fmt::format("option order: found {}, expected 1 to 4", options.order));
  }
  MethodInfo info =
      info_of("ts_basicsymplectic", fmt::format("PETSc TS, symplectic splitting of order {}", options.order),
              options.order);
  info.is_explicit = true;
  info.is_adaptive = false;
  info.is_symplectic = true;
  info.is_symmetric = options.order == 2;
  info.formula = "for each i: v += c_i h f(t, q)/M, q += d_i h v, t += d_i h";
  info.needs = {Capability::second_order, Capability::position_forces};
  return make(
      std::move(info),
      {.type = TSBASICSYMPLECTIC,
       .form = TsForm::hamiltonian,
       .configure = [order = options.order](
                        TS ts) { petsc_check(TSBasicSymplecticSetType(ts, std::to_string(order).c_str())); },
       .petsc_options = options.petsc});
}

}  // namespace fw::oracles
