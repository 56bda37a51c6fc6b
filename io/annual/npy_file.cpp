#include "io/annual/npy_file.h"

#include <bit>

#include "io/text.h"
#include "solver/model/assert.h"

namespace clerestory {
namespace {

template <class Number>
std::string_view bytes_of(std::span<const Number> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

}  // namespace

std::string npy_header(const char* type, std::initializer_list<std::size_t> shape) {
  std::string sizes;
  for (const std::size_t n : shape) sizes += text(n, ", ");
  if (shape.size() > 1) sizes.resize(sizes.size() - 2);
  if (shape.size() == 1) sizes.pop_back();  // "(8, )" is read, "(8,)" is what NumPy writes
  std::string dictionary = text("{'descr': '", std::endian::native == std::endian::little ? '<' : '>', type,
                                "', 'fortran_order': False, 'shape': (", sizes, "), }");
  constexpr std::size_t kBefore = 10, kAlign = 64;  // magic, version, length
  dictionary.append(kAlign - (kBefore + dictionary.size() + 1) % kAlign, ' ');
  dictionary += '\n';
  const auto length = static_cast<unsigned>(dictionary.size());
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(length & 255);
  header += static_cast<char>(length >> 8);
  return header + dictionary;
}

void write_npy(AtomicFile& file, std::span<const int> values) {
  static_assert(sizeof(int) == 4);
  file.write(npy_header("i4", {values.size()}));
  file.write(bytes_of(values));
}

void write_npy(AtomicFile& file, std::span<const double> values, std::size_t columns) {
  file.write(npy_header("f8", {values.size() / columns, columns}));
  file.write(bytes_of(values));
}

NpyRows::NpyRows(AtomicFile& file, std::size_t rows, std::size_t columns) : file_(file), missing_(rows * columns) {
  file_.write(npy_header("f4", {rows, columns}));
}

void NpyRows::add(std::span<const float> values) {
  CLERESTORY_ASSERT(values.size(), <=, missing_);
  file_.write(bytes_of(values));
  missing_ -= values.size();
}

void NpyRows::end() const { CLERESTORY_ASSERT(missing_, ==, std::size_t{0}); }

}  // namespace clerestory
