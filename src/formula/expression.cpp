#include "formula/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"

namespace fw::formula {

namespace {

using Code = Expression::Code;

struct Function {
  std::string_view name;
  Code code;
  int arguments;
};

constexpr Function functions[] = {{"sqrt", Code::sqrt, 1}, {"exp", Code::exp, 1},   {"log", Code::log, 1},
                                  {"sin", Code::sin, 1},   {"cos", Code::cos, 1},   {"tan", Code::tan, 1},
                                  {"sinh", Code::sinh, 1}, {"cosh", Code::cosh, 1}, {"tanh", Code::tanh, 1},
                                  {"abs", Code::abs, 1},   {"min", Code::min, 2},   {"max", Code::max, 2}};

std::string function_names() {
  std::string names;
  for (const Function& function : functions)
    names += fmt::format("{}{}", names.empty() ? "" : " ", function.name);
  return names;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/// Whether a byte is not the first one of its character in UTF-8.
bool is_continued(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

/// Recursive descent over the text; writes the program as it goes.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, std::vector<Expression::Instruction>& program)
      : text_(text), program_(program) {}

  void parse() {
    sum();
    if (!at_end()) expected("an operator or the end");
  }

 private:
  /// Nested parentheses and signs.
  static constexpr int most_nested = 100;

  void skip_blanks() {
    while (place_ < text_.size() && (text_[place_] == ' ' || text_[place_] == '\t')) ++place_;
  }
  bool at_end() {
    skip_blanks();
    return place_ == text_.size();
  }
  char next() { return at_end() ? '\0' : text_[place_]; }
  bool take(char c) {
    if (next() != c) return false;
    ++place_;
    return true;
  }

  [[noreturn]] void refuse(std::size_t place, const std::string& message) const {
    std::size_t shown = std::min(text_.size(), std::size_t{80});
    while (shown > 0 && shown < text_.size() && is_continued(text_[shown])) --shown;
    const std::string quoted = fmt::format("{}{}", text_.substr(0, shown), shown < text_.size() ? "..." : "");
    throw InputError(fmt::format("\"{}\", character {}: {}", quoted, place + 1, message));
  }
  [[noreturn]] void expected(std::string_view what) {
    if (at_end()) refuse(place_, fmt::format("found the end, expected {}", what));
    std::size_t end = place_ + 1;
    while (end < text_.size() && is_continued(text_[end])) ++end;
    refuse(place_, fmt::format("found \"{}\", expected {}", text_.substr(place_, end - place_), what));
  }

  void emit(Code code, int operands, double number = 0.0) {
    program_.push_back({code, number});
    waiting_ += 1 - operands;
    if (waiting_ > static_cast<int>(Expression::deepest)) {
      refuse(place_, fmt::format("found more than {} operands that wait for an operator, expected a simpler "
                                 "expression",
                                 Expression::deepest));
    }
  }

  void sum() {
    product();
    for (;;) {
      if (take('+')) {
        product();
        emit(Code::add, 2);
      } else if (take('-')) {
        product();
        emit(Code::subtract, 2);
      } else {
        return;
      }
    }
  }

  void product() {
    sign();
    for (;;) {
      if (take('*')) {
        sign();
        emit(Code::multiply, 2);
      } else if (take('/')) {
        sign();
        emit(Code::divide, 2);
      } else {
        return;
      }
    }
  }

  void sign() {
    if (++nested_ > most_nested) {
      refuse(place_, fmt::format("found more than {} nested signs and parentheses", most_nested));
    }
    if (take('-')) {
      sign();
      emit(Code::negate, 1);
    } else if (take('+')) {
      sign();
    } else {
      power();
    }
    --nested_;
  }

  void power() {
    primary();
    if (!take('^')) return;
    sign();
    emit(Code::power, 2);
  }

  void primary() {
    const char c = next();
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    if (!take('(')) expected("a number, t, pi, a function or \"(\"");
    sum();
    if (!take(')')) expected("\")\"");
  }

  void number() {
    double value = 0.0;
    const char* begin = text_.data() + place_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) {
      expected("a number in the range of double precision, such as 0.5 or 1e-3");
    }
    place_ += static_cast<std::size_t>(end - begin);
    emit(Code::number, 0, value);
  }

  void name() {
    const std::size_t begin = place_;
    std::size_t end = begin;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    const std::string_view word = text_.substr(begin, end - begin);
    place_ = end;
    if (word == "t") return emit(Code::time, 0);
    if (word == "pi") return emit(Code::number, 0, std::numbers::pi);
    const auto* function = std::ranges::find(functions, word, &Function::name);
    if (function == std::end(functions)) {
      refuse(begin,
             fmt::format("found \"{}\", expected t, pi or one of the functions {}", word, function_names()));
    }
    if (!take('(')) expected(fmt::format("\"(\" after {}", word));
    for (int k = 0; k < function->arguments; ++k) {
      if (k > 0 && !take(',')) expected(fmt::format("\",\": {} has {} arguments", word, function->arguments));
      sum();
    }
    if (!take(')')) expected("\")\"");
    emit(function->code, function->arguments);
  }

  std::string_view text_;
  std::vector<Expression::Instruction>& program_;
  std::size_t place_ = 0;
  int nested_ = 0, waiting_ = 0;
};

}  // namespace

Expression::Expression(std::string_view text) {
  ExpressionParser(text, program_).parse();
  is_smooth_ = std::ranges::none_of(program_, [](const Instruction& instruction) {
    return instruction.code == Code::abs || instruction.code == Code::min || instruction.code == Code::max;
  });
}

template <class Scalar>
Jet<Scalar> Expression::evaluate(const Scalar& t) const {
  std::array<Jet<Scalar>, deepest> stack;
  std::size_t top = 0;  // number of operands
  for (const Instruction& instruction : program_) {
    if (instruction.code == Code::number || instruction.code == Code::time) {
      stack[top++] = instruction.code == Code::time ? Jet<Scalar>{t, Scalar(1)}
                                                    : Jet<Scalar>{Scalar(instruction.number), Scalar(0)};
      continue;
    }
    const bool is_binary =
        (instruction.code >= Code::add && instruction.code <= Code::power) || instruction.code >= Code::min;
    if (is_binary) --top;
    Jet<Scalar>& a = stack[top - 1];
    const Jet<Scalar>& b = stack[top];  // of binary ones
    switch (instruction.code) {
      case Code::number:
      case Code::time:
        break;
      case Code::add:
        a = a + b;
        break;
      case Code::subtract:
        a = a - b;
        break;
      case Code::multiply:
        a = a * b;
        break;
      case Code::divide:
        a = a / b;
        break;
      case Code::power:
        a = pow(a, b);
        break;
      case Code::negate:
        a = -a;
        break;
      case Code::sqrt:
        a = sqrt(a);
        break;
      case Code::exp:
        a = exp(a);
        break;
      case Code::log:
        a = log(a);
        break;
      case Code::sin:
        a = sin(a);
        break;
      case Code::cos:
        a = cos(a);
        break;
      case Code::tan:
        a = tan(a);
        break;
      case Code::sinh:
        a = sinh(a);
        break;
      case Code::cosh:
        a = cosh(a);
        break;
      case Code::tanh:
        a = tanh(a);
        break;
      case Code::abs:
        a = abs(a);
        break;
      case Code::min:
        a = min(a, b);
        break;
      case Code::max:
        a = max(a, b);
        break;
    }
  }
  return stack[0];
}

Jet<double> Expression::operator()(double t) const {
  return evaluate(t);
}
Jet<Float128> Expression::operator()(const Float128& t) const {
  return evaluate(t);
}

}  // namespace fw::formula
