#include "oracles/sundials/eigen_vector.hpp"

#include <nvector/nvector_serial.h>

#include <cstdlib>
#include <cstring>

#include "oracles/sundials/eigen_vector_operations.hpp"

namespace fw::oracles::detail {

namespace {

/// A cache line, and the widest registers there are.
constexpr std::size_t alignment = 64;

N_VectorContent_Serial content(N_Vector vector) {
  return static_cast<N_VectorContent_Serial>(vector->content);
}

/// Memory that std::free releases, as the serial vector's does.
double* allocate(sunindextype length) {
  const std::size_t bytes = static_cast<std::size_t>(length) * sizeof(double);
  const std::size_t whole_lines = (bytes + alignment - 1) / alignment * alignment;
  return static_cast<double*>(std::aligned_alloc(alignment, whole_lines == 0 ? alignment : whole_lines));
}

N_Vector_ID identify(N_Vector) {
  return SUNDIALS_NVEC_SERIAL;
}

void destroy(N_Vector vector) {
  if (vector == nullptr) return;
  if (vector->content != nullptr) {
    if (content(vector)->own_data) std::free(content(vector)->data);
    std::free(vector->content);
    vector->content = nullptr;
  }
  N_VFreeEmpty(vector);
}

void set_life_cycle(_generic_N_Vector_Ops& table);

const _generic_N_Vector_Ops& operations() {
  static const _generic_N_Vector_Ops table = [] {
    _generic_N_Vector_Ops made{};
    set_life_cycle(made);
    set_standard_operations(made);
    set_fused_operations(made);
    return made;
  }();
  return table;
}

/// A vector without entries; null where memory is exhausted, as SUNDIALS expects it.
N_Vector make_empty(sunindextype length, SUNContext context) {
  N_Vector vector = N_VNewEmpty(context);
  if (vector == nullptr) return nullptr;
  *vector->ops = operations();
  auto* made = static_cast<N_VectorContent_Serial>(std::malloc(sizeof(_N_VectorContent_Serial)));
  vector->content = made;
  if (made == nullptr) {
    destroy(vector);
    return nullptr;
  }
  made->length = length;
  made->own_data = SUNFALSE;
  made->data = nullptr;
  return vector;
}

N_Vector make(sunindextype length, SUNContext context) {
  N_Vector vector = make_empty(length, context);
  if (vector == nullptr) return nullptr;
  content(vector)->data = allocate(length);
  content(vector)->own_data = SUNTRUE;
  if (content(vector)->data == nullptr) {
    destroy(vector);
    return nullptr;
  }
  return vector;
}

/// The norms of `of` for `vector`, which may be null.
N_Vector with_norms(N_Vector vector, N_Vector of) {
  if (vector == nullptr) return nullptr;
  vector->ops->nvwrmsnorm = of->ops->nvwrmsnorm;
  vector->ops->nvwrmsnormmask = of->ops->nvwrmsnormmask;
  return vector;
}

N_Vector clone_empty(N_Vector vector) {
  return with_norms(make_empty(content(vector)->length, vector->sunctx), vector);
}

N_Vector clone(N_Vector vector) {
  return with_norms(make(content(vector)->length, vector->sunctx), vector);
}

void space(N_Vector vector, sunindextype* reals, sunindextype* integers) {
  *reals = content(vector)->length;
  *integers = 1;
}

double* array_pointer(N_Vector vector) {
  return content(vector)->data;
}

void set_array_pointer(double* data, N_Vector vector) {
  if (content(vector)->length > 0) content(vector)->data = data;
}

sunindextype length(N_Vector vector) {
  return content(vector)->length;
}

int buffer_size(N_Vector vector, sunindextype* bytes) {
  *bytes = content(vector)->length * static_cast<sunindextype>(sizeof(double));
  return 0;
}

int pack(N_Vector vector, void* buffer) {
  std::memcpy(buffer, content(vector)->data,
              static_cast<std::size_t>(content(vector)->length) * sizeof(double));
  return 0;
}

int unpack(N_Vector vector, void* buffer) {
  std::memcpy(content(vector)->data, buffer,
              static_cast<std::size_t>(content(vector)->length) * sizeof(double));
  return 0;
}

void set_life_cycle(_generic_N_Vector_Ops& table) {
  table.nvgetvectorid = identify;
  table.nvclone = clone;
  table.nvcloneempty = clone_empty;
  table.nvdestroy = destroy;
  table.nvspace = space;
  table.nvgetarraypointer = array_pointer;
  table.nvsetarraypointer = set_array_pointer;
  table.nvgetlength = length;
  table.nvgetlocallength = length;
  table.nvbufsize = buffer_size;
  table.nvbufpack = pack;
  table.nvbufunpack = unpack;
  table.nvprint = N_VPrint_Serial;
  table.nvprintfile = N_VPrintFile_Serial;
}

}  // namespace

VectorPointer new_eigen_vector(Index size, SUNContext context) {
  return own<VectorPointer>(make(size, context), "the vector's constructor");
}

VectorPointer wrap_eigen_vector(VectorRef entries, SUNContext context) {
  VectorPointer vector = own<VectorPointer>(make_empty(entries.size(), context), "the vector's constructor");
  content(vector.get())->data = entries.data();
  return vector;
}

VectorPointer new_vector(Index size, VectorOperations operations, SUNContext context) {
  if (operations == VectorOperations::eigen) return new_eigen_vector(size, context);
  return own<VectorPointer>(N_VNew_Serial(size, context), "N_VNew_Serial");
}

VectorPointer wrap_vector(VectorRef entries, VectorOperations operations, SUNContext context) {
  if (operations == VectorOperations::eigen) return wrap_eigen_vector(entries, context);
  return own<VectorPointer>(N_VMake_Serial(entries.size(), entries.data(), context), "N_VMake_Serial");
}

VectorPointer wrap_state(VectorRef entries, bool is_of_particles, VectorOperations operations,
                         SUNContext context) {
  VectorPointer state = wrap_vector(entries, operations, context);
  if (operations == VectorOperations::eigen && is_of_particles) set_norm_of_particles(*state->ops);
  return state;
}

}  // namespace fw::oracles::detail
