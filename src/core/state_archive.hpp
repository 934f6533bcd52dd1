#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace fw {

/// Visits the members of an object that can be saved and continued: `StateWriter` copies them into bytes,
/// `StateReader` puts them back. An object has one function `serialise(StateArchive&)` for both ways, which
/// names every member that its next step reads; work space that is written before it is read stays out.
///
/// The bytes are a list of items (type, name, number of entries, entries) in the order of the visits, doubles
/// bit for bit in the byte order of this machine. A reader compares type, name and, where an object has a
/// size of its own, the number of entries: bytes of another object are refused with an InputError that says
/// what was found and what was expected.
class StateArchive {
 public:
  virtual ~StateArchive() = default;

  virtual bool is_loading() const = 0;

  void visit(std::string_view name, double& value);
  void visit(std::string_view name, bool& value);
  void visit(std::string_view name, std::uint64_t& value);
  /// A text of any length.
  void visit(std::string_view name, std::string& value);
  /// Vectors and arrays keep their sizes: those of the reading object are the expected ones.
  void visit(std::string_view name, Vector& value);
  void visit(std::string_view name, Matrix& value);
  void visit(std::string_view name, std::vector<double>& value);
  void visit(std::string_view name, std::vector<Vector>& value);
  /// An array that takes the size of what is read.
  void visit_any_size(std::string_view name, std::vector<double>& value);
  /// A compressed matrix of any size and pattern.
  void visit(std::string_view name, SparseMatrix& value);

  /// What has to be the same in both objects, such as the name of a method or a step: saved, and compared by
  /// the reader. Throws InputError ("the step is 0.1, expected 0.2").
  void require_equal(std::string_view name, const std::string& value);
  void require_equal(std::string_view name, double value);

 private:
  enum class Type : char { number = 'd', flag = 'b', count = 'u', text = 't', vector = 'v', indices = 'i' };

  /// Whether an item has a fixed number of entries.
  enum class Size { fixed, free };

  /// Writes the head of an item, or reads and compares it; the number of entries that follow.
  virtual std::uint64_t head(std::string_view name, char type, std::uint64_t entries,
                             std::uint64_t entry_size, bool is_fixed) = 0;
  /// Writes or reads `size` bytes.
  virtual void data(void* bytes, std::size_t size) = 0;

  std::uint64_t head(std::string_view name, Type type, std::uint64_t entries, std::uint64_t entry_size,
                     Size size);
};

/// Saves into memory.
class StateWriter final : public StateArchive {
 public:
  bool is_loading() const override { return false; }
  const std::string& bytes() const { return bytes_; }
  /// Empties it and keeps the memory.
  void clear() { bytes_.clear(); }

 private:
  std::uint64_t head(std::string_view name, char type, std::uint64_t entries, std::uint64_t entry_size,
                     bool is_fixed) override;
  void data(void* bytes, std::size_t size) override;

  std::string bytes_;
};

/// Loads from memory, which outlives it. Every visit throws InputError where the bytes are of another object,
/// or end.
class StateReader final : public StateArchive {
 public:
  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}

  bool is_loading() const override { return true; }
  /// Throws InputError if bytes are left that nobody has asked for.
  void finish() const;

 private:
  std::uint64_t head(std::string_view name, char type, std::uint64_t entries, std::uint64_t entry_size,
                     bool is_fixed) override;
  void data(void* bytes, std::size_t size) override;

  std::string_view bytes_;
  std::size_t place_ = 0;
};

}  // namespace fw
