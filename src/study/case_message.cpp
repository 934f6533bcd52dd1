#include "study/case_message.hpp"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace fw::study {

namespace {

class Writer {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    out_.append(bytes, sizeof number);
  }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    out_ += text;
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const Value& value : values) add(value);
  }
  template <class... Values>
  void add(const std::variant<Values...>& value) {
    add(static_cast<std::uint8_t>(value.index()));
    std::visit([&](const auto& held) { add(held); }, value);
  }
  void add(const std::pair<std::string, std::string>& both) {
    add(both.first);
    add(both.second);
  }
  void add(const Column& column) {
    add(column.name);
    add(column.unit);
    add(column.values);
    add(column.shape);
    add(column.attributes);
  }
  void add(const SummaryCell& cell) {
    add(cell.name);
    add(cell.unit);
    add(cell.value);
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void read(Number& number) { std::memcpy(&number, next(sizeof number), sizeof number); }
  void read(std::string& text) {
    const std::size_t size = count();
    text.assign(next(size), size);
  }
  template <class Value>
  void read(std::vector<Value>& values) {
    values.resize(count());
    for (Value& value : values) read(value);
  }
  template <class... Values>
  void read(std::variant<Values...>& value) {
    std::uint8_t index = 0;
    read(index);
    if (index >= sizeof...(Values)) throw std::runtime_error("a case's message has an unknown type");
    std::size_t k = 0;
    const auto take = [&]<class Value>(std::type_identity<Value>) {
      if (k++ == index) read(value.template emplace<Value>());
    };
    (take(std::type_identity<Values>{}), ...);
  }
  void read(std::pair<std::string, std::string>& both) {
    read(both.first);
    read(both.second);
  }
  void read(Column& column) {
    read(column.name);
    read(column.unit);
    read(column.values);
    read(column.shape);
    read(column.attributes);
  }
  void read(SummaryCell& cell) {
    read(cell.name);
    read(cell.unit);
    read(cell.value);
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  const char* next(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("a case's message is cut off");
    const char* data = bytes_.data();
    bytes_.remove_prefix(size);
    return data;
  }
  /// Of entries that take at least a byte each.
  std::size_t count() {
    std::uint64_t size = 0;
    read(size);
    if (size > bytes_.size()) throw std::runtime_error("a case's message is cut off");
    return static_cast<std::size_t>(size);
  }

  std::string_view bytes_;
};

}  // namespace

std::string encode(const CaseResult& result) {
  Writer out;
  out.add(result.id);
  out.add(result.key);
  out.add(result.columns);
  out.add(result.summary);
  out.add(result.parameters);
  out.add(static_cast<std::uint8_t>(result.verdict));
  out.add(result.reason);
  return out.take();
}

CaseResult decode(std::string_view bytes) {
  Reader in(bytes);
  CaseResult result;
  std::uint8_t verdict = 0;
  in.read(result.id);
  in.read(result.key);
  in.read(result.columns);
  in.read(result.summary);
  in.read(result.parameters);
  in.read(verdict);
  in.read(result.reason);
  if (verdict > static_cast<std::uint8_t>(Verdict::done)) {
    throw std::runtime_error(
        fmt::format("corrupt message from a worker: found verdict {}, expected at most {}", verdict,
                    static_cast<int>(Verdict::not_applicable)));
  }
  if (!in.at_end()) throw std::runtime_error("corrupt message from a worker: it goes on after its end");
  result.verdict = static_cast<Verdict>(verdict);
  return result;
}

}  // namespace fw::study
