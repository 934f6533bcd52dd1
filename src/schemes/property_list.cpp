#include "schemes/property_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fw::schemes {

namespace {

std::string order_or_none(int order) {
  return order < 0 ? "none" : std::to_string(order);
}

/// A coefficient as a fraction with a small denominator where it is one, else with six digits.
std::string simple_fraction(const Float128& value) {
  for (int denominator = 1; denominator <= 40320; ++denominator) {
    const Float128 numerator = value * denominator;
    const Float128 nearest = round(numerator);
    if (abs(numerator - nearest) < 1e-20 * denominator) {
      const auto whole = static_cast<long long>(nearest);
      return denominator == 1 ? fmt::format("{}", whole) : fmt::format("{}/{}", whole, denominator);
    }
  }
  return fmt::format("{:.6g}", static_cast<double>(value));
}

std::string polynomial_text(const std::vector<Float128>& p) {
  std::string text;
  for (std::size_t k = 0; k < p.size(); ++k) {
    if (p[k] == 0) continue;
    const bool negative = p[k] < 0;
    const std::string power = k == 0 ? "" : k == 1 ? "z" : fmt::format("z^{}", k);
    std::string factor = simple_fraction(negative ? Float128(-p[k]) : p[k]);
    if (k > 0) {
      // 1/2 z is written z/2, 3/8 z is written 3z/8.
      const auto slash = factor.find('/');
      const std::string numerator = factor.substr(0, slash);
      factor = (numerator == "1" ? "" : numerator + (slash == std::string::npos ? " " : "")) + power +
               (slash == std::string::npos ? "" : factor.substr(slash));
    }
    text += text.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
    text += factor;
  }
  return text.empty() ? "0" : text;
}

std::string cell(const Coefficient& c) {
  constexpr std::size_t widest = 22;
  return c.text().size() <= widest ? c.text() : fmt::format("{:.15g}", static_cast<double>(c.value()));
}

/// Rows of cells with a bar after the first column, columns as wide as their widest cell.
class Grid {
 public:
  void add(const std::string& head, const CoefficientRow& row, std::size_t columns) {
    std::vector<std::string> cells = {head};
    for (std::size_t j = 0; j < columns; ++j) cells.push_back(j < row.size() ? cell(row[j]) : "");
    rows_.push_back(std::move(cells));
  }
  std::string text() const {
    std::vector<std::size_t> width;
    for (const auto& row : rows_) {
      width.resize(std::max(width.size(), row.size()), 0);
      for (std::size_t j = 0; j < row.size(); ++j) width[j] = std::max(width[j], row[j].size());
    }
    std::string result;
    for (const auto& row : rows_) {
      std::string line = "  ";
      for (std::size_t j = 0; j < row.size(); ++j) {
        line += fmt::format("{:>{}}{}", row[j], width[j], j == 0 ? " | " : "  ");
      }
      line.erase(line.find_last_not_of(' ') + 1);
      result += line + '\n';
    }
    return result;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string node_text(const CoefficientRow& row) {
  bool rational = true;
  Rational sum = 0;
  Float128 value = 0;
  for (const Coefficient& c : row) {
    value += c.value();
    rational = rational && c.rational();
    if (rational) sum += *c.rational();
  }
  const std::string exact = rational ? sum.str() : "";
  return rational && exact.size() <= 22 ? exact : fmt::format("{:.15g}", static_cast<double>(value));
}

std::string text_of(std::monostate) {
  return {};
}

std::string text_of(const ButcherTableau& t) {
  Grid grid;
  const std::size_t s = t.b.size();
  for (std::size_t i = 0; i < s; ++i) grid.add(node_text(t.A[i]), t.A[i], s);
  grid.add("b", t.b, s);
  if (!t.b_embedded.empty()) grid.add("b^", t.b_embedded, s);
  return "Butcher tableau (c | A, then the weights b and, where there are any, the embedded b^)\n" +
         grid.text();
}

std::string text_of(const NystromTableau& t) {
  Grid grid;
  const std::size_t s = t.c.size();
  for (std::size_t i = 0; i < s; ++i) grid.add(cell(t.c[i]), t.A_position[i], s);
  grid.add("b (q)", t.b_position, s);
  grid.add("b (v)", t.b_velocity, s);
  if (!t.b_position_embedded.empty()) {
    grid.add("b^ (q)", t.b_position_embedded, s);
    grid.add("b^ (v)", t.b_velocity_embedded, s);
  }
  for (std::size_t i = 0; i < t.A_velocity.size(); ++i) grid.add("a (v)", t.A_velocity[i], s);
  return "Nystroem tableau (c | A of the positions, the weights of q and v, then A of the velocities)\n" +
         grid.text();
}

std::string text_of(const SplittingScheme& t) {
  Grid grid;
  grid.add("drift", t.drift, t.drift.size());
  grid.add("kick", t.kick, t.drift.size());
  return "Splitting (drift, kick, drift, kick, ..., drift; fractions of the step)\n" + grid.text();
}

std::string text_of(const RosenbrockTableau& t) {
  Grid grid;
  const std::size_t s = t.b.size();
  for (const CoefficientRow& row : t.alpha) grid.add("alpha", row, s);
  for (const CoefficientRow& row : t.gamma) grid.add("gamma", row, s);
  grid.add("b", t.b, s);
  if (!t.b_embedded.empty()) grid.add("b^", t.b_embedded, s);
  return "Rosenbrock coefficients\n" + grid.text();
}

std::string text_of(const AdditiveTableau& t) {
  return "Explicit part (soft forces): " + text_of(t.explicit_part) +
         "Implicit part (stiff forces): " + text_of(t.implicit_part);
}

std::string text_of(const MultistepFormula& t) {
  Grid grid;
  grid.add("alpha", t.alpha, t.alpha.size());
  grid.add("beta", t.beta, t.beta.size());
  return "Multistep formula (oldest value first)\n" + grid.text();
}

}  // namespace

std::string to_text(const StabilityFunction& R) {
  const std::string numerator = polynomial_text(R.numerator), denominator = polynomial_text(R.denominator);
  if (denominator == "1") return numerator;
  return "(" + numerator + ")/(" + denominator + ")";
}

std::vector<NamedProperty> property_list(const DerivedProperties& p) {
  std::vector<NamedProperty> list;
  const auto add_int = [&](const char* key, const char* label, const std::optional<int>& value) {
    if (value) list.push_back({key, label, std::int64_t{*value}});
  };
  const auto add_bool = [&](const char* key, const char* label, const std::optional<bool>& value) {
    if (value) list.push_back({key, label, *value});
  };
  add_int("order", "order (positions)", p.order);
  add_int("order_with_velocity_forces", "order with dampers", p.order_with_velocity_forces);
  add_int("embedded_order", "embedded order", p.embedded_order);
  add_int("stage_order", "stage order", p.stage_order);
  add_int("quadrature_order", "quadrature order", p.quadrature_order);
  if (p.principal_error) list.push_back({"principal_error", "principal error", *p.principal_error});
  add_bool("first_same_as_last", "first same as last", p.first_same_as_last);
  add_bool("stiffly_accurate", "stiffly accurate", p.stiffly_accurate);
  add_bool("algebraically_stable", "B-stable (algebraically)", p.algebraically_stable);
  add_bool("symplectic", "symplectic", p.symplectic);
  add_bool("symmetric", "symmetric", p.symmetric);
  if (p.stability_function) {
    list.push_back({"stability_function", "stability function R(z)", to_text(*p.stability_function)});
  }
  if (p.stability) {
    const LinearStability& s = *p.stability;
    list.push_back({"real_stability_interval", "real stability interval", s.real_interval});
    list.push_back({"imaginary_stability_interval", "imaginary stab. interval", s.imaginary_interval});
    list.push_back({"a_stable", "A-stable", s.is_a_stable});
    list.push_back({"l_stable", "L-stable", s.is_l_stable});
    list.push_back({"alpha_degrees", "A(alpha), degrees", s.alpha_degrees});
    list.push_back({"stability_at_infinity", "|R(infinity)|", s.at_infinity});
    list.push_back({"linear_error_constant", "linear error constant", s.error_constant});
    list.push_back({"dispersion_order", "dispersion order", order_or_none(s.dispersion_order)});
    list.push_back({"dissipation_order", "dissipation order",
                    s.dissipation_order < 0 ? "none (|R(iy)| = 1)" : std::to_string(s.dissipation_order)});
  }
  add_bool("zero_stable", "zero-stable", p.zero_stable);
  if (p.stability_angle) {
    list.push_back({"a_stable", "A-stable", *p.stability_angle >= 90.0});
    list.push_back({"alpha_degrees", "A(alpha), degrees", *p.stability_angle});
  }
  if (p.error_constant) list.push_back({"error_constant", "error constant", *p.error_constant});
  if (p.oscillator) {
    list.push_back({"oscillator_stability_interval", "stable up to h omega", p.oscillator->interval});
    list.push_back({"dispersion_order", "dispersion order", order_or_none(p.oscillator->dispersion_order)});
    list.push_back({"dissipation_order", "dissipation order",
                    p.oscillator->dissipation_order < 0 ? "none (det = 1)"
                                                        : std::to_string(p.oscillator->dissipation_order)});
  }
  return list;
}

std::string to_text(const NamedProperty& property) {
  struct Writer {
    std::string operator()(bool truth) const { return truth ? "yes" : "no"; }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(double number) const {
      return std::isinf(number) ? "infinite" : fmt::format("{:.6g}", number);
    }
    std::string operator()(const std::string& text) const { return text; }
  };
  return std::visit(Writer{}, property.value);
}

std::string coefficients_text(const SchemeData& data) {
  return std::visit([](const auto& scheme) { return text_of(scheme); }, data);
}

}  // namespace fw::schemes
