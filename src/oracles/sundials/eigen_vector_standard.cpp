#include <nvector/nvector_serial.h>

#include <cmath>

#include "core/types.hpp"
#include "integrators/loop/particle_norm.hpp"
#include "oracles/sundials/eigen_vector_operations.hpp"

namespace fw::oracles::detail {

namespace {

using ArrayMap = Eigen::Map<Eigen::ArrayXd>;

/// Expressions are taken over the maps directly: an elementwise assignment reads entry i of every input
/// before it writes entry i, so that outputs may be inputs.
ArrayMap array(N_Vector vector) {
  return {NV_DATA_S(vector), NV_LENGTH_S(vector)};
}

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  // 1·x is x: only where both factors are 1 is there a multiplication worth leaving out.
  if (a == 1.0 && b == 1.0) {
    array(z) = array(x) + array(y);
  } else {
    array(z) = a * array(x) + b * array(y);
  }
}

void constant(double c, N_Vector z) {
  array(z).setConstant(c);
}

void product(N_Vector x, N_Vector y, N_Vector z) {
  array(z) = array(x) * array(y);
}

void quotient(N_Vector x, N_Vector y, N_Vector z) {
  array(z) = array(x) / array(y);
}

void scale(double c, N_Vector x, N_Vector z) {
  if (c == 1.0 && NV_DATA_S(x) == NV_DATA_S(z)) return;
  array(z) = c * array(x);
}

void absolute(N_Vector x, N_Vector z) {
  array(z) = array(x).abs();
}

void inverse(N_Vector x, N_Vector z) {
  array(z) = 1.0 / array(x);
}

void add_constant(N_Vector x, double b, N_Vector z) {
  array(z) = array(x) + b;
}

double dot_product(N_Vector x, N_Vector y) {
  return (array(x) * array(y)).sum();
}

double maximum_norm(N_Vector x) {
  return NV_LENGTH_S(x) == 0 ? 0.0 : array(x).abs().maxCoeff<Eigen::PropagateNaN>();
}

double minimum(N_Vector x) {
  return NV_LENGTH_S(x) == 0 ? BIG_REAL : array(x).minCoeff<Eigen::PropagateNaN>();
}

double l1_norm(N_Vector x) {
  return array(x).abs().sum();
}

double weighted_square_sum(N_Vector x, N_Vector w) {
  return (array(x) * array(w)).square().sum();
}

double weighted_square_sum_mask(N_Vector x, N_Vector w, N_Vector id) {
  // A select and not a product: what is masked may be NaN.
  return (array(id) > 0.0).select((array(x) * array(w)).square(), 0.0).sum();
}

double root_mean_square(double square_sum, N_Vector x) {
  return std::sqrt(square_sum / static_cast<double>(NV_LENGTH_S(x)));
}

double wrms_norm(N_Vector x, N_Vector w) {
  return root_mean_square(weighted_square_sum(x, w), x);
}

double wrms_norm_mask(N_Vector x, N_Vector w, N_Vector id) {
  return root_mean_square(weighted_square_sum_mask(x, w, id), x);
}

double particle_norm(N_Vector x, N_Vector w) {
  const double *values = NV_DATA_S(x), *weights = NV_DATA_S(w);
  return integrators::largest_particle_norm(NV_LENGTH_S(x), [&](Index i) { return values[i] * weights[i]; });
}

double particle_norm_mask(N_Vector x, N_Vector w, N_Vector id) {
  const double *values = NV_DATA_S(x), *weights = NV_DATA_S(w), *mask = NV_DATA_S(id);
  return integrators::largest_particle_norm(
      NV_LENGTH_S(x), [&](Index i) { return mask[i] > 0.0 ? values[i] * weights[i] : 0.0; });
}

double weighted_l2_norm(N_Vector x, N_Vector w) {
  return std::sqrt(weighted_square_sum(x, w));
}

/// z = 1 where |x| >= c, else 0.
void compare(double c, N_Vector x, N_Vector z) {
  array(z) = (array(x).abs() >= c).cast<double>();
}

/// z = 1/x where x is not zero; entries of z where x is zero stay. Whether there were none.
booleantype inverse_test(N_Vector x, N_Vector z) {
  const double* from = NV_DATA_S(x);
  double* to = NV_DATA_S(z);
  bool no_zero = true;
  for (sunindextype i = 0; i < NV_LENGTH_S(x); ++i) {
    if (from[i] == 0.0) {
      no_zero = false;
    } else {
      to[i] = 1.0 / from[i];
    }
  }
  return no_zero ? SUNTRUE : SUNFALSE;
}

/// m = 1 where x violates its constraint, else 0: c = 2 asks for x > 0, 1 for x >= 0, −1 for x <= 0, −2 for
/// x < 0, 0 for nothing. Whether none is violated.
booleantype constraint_mask(N_Vector c, N_Vector x, N_Vector m) {
  const double* kind = NV_DATA_S(c);
  const double* value = NV_DATA_S(x);
  double* mask = NV_DATA_S(m);
  bool none = true;
  for (sunindextype i = 0; i < NV_LENGTH_S(x); ++i) {
    const double strength = std::abs(kind[i]);
    const double signed_value = value[i] * kind[i];
    const bool violated = (strength > 1.5 && signed_value <= 0.0) || (strength > 0.5 && signed_value < 0.0);
    mask[i] = violated ? 1.0 : 0.0;
    none = none && !violated;
  }
  return none ? SUNTRUE : SUNFALSE;
}

/// min x/y over the entries with y ≠ 0, the largest number where there is none.
double minimum_quotient(N_Vector numerator, N_Vector denominator) {
  const double* x = NV_DATA_S(numerator);
  const double* y = NV_DATA_S(denominator);
  double least = BIG_REAL;
  for (sunindextype i = 0; i < NV_LENGTH_S(numerator); ++i) {
    if (y[i] != 0.0) least = std::min(least, x[i] / y[i]);
  }
  return least;
}

}  // namespace

void set_norm_of_particles(_generic_N_Vector_Ops& table) {
  table.nvwrmsnorm = particle_norm;
  table.nvwrmsnormmask = particle_norm_mask;
}

void set_standard_operations(_generic_N_Vector_Ops& table) {
  table.nvlinearsum = linear_sum;
  table.nvconst = constant;
  table.nvprod = product;
  table.nvdiv = quotient;
  table.nvscale = scale;
  table.nvabs = absolute;
  table.nvinv = inverse;
  table.nvaddconst = add_constant;
  table.nvdotprod = table.nvdotprodlocal = dot_product;
  table.nvmaxnorm = table.nvmaxnormlocal = maximum_norm;
  table.nvwrmsnorm = wrms_norm;
  table.nvwrmsnormmask = wrms_norm_mask;
  table.nvmin = table.nvminlocal = minimum;
  table.nvwl2norm = weighted_l2_norm;
  table.nvl1norm = table.nvl1normlocal = l1_norm;
  table.nvcompare = compare;
  table.nvinvtest = table.nvinvtestlocal = inverse_test;
  table.nvconstrmask = table.nvconstrmasklocal = constraint_mask;
  table.nvminquotient = table.nvminquotientlocal = minimum_quotient;
  table.nvwsqrsumlocal = weighted_square_sum;
  table.nvwsqrsummasklocal = weighted_square_sum_mask;
}

}  // namespace fw::oracles::detail
