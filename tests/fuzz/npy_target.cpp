// Numpy files.
#include <string>

#include "base/npy.h"
#include "fuzz/targets.h"

namespace aspic::fuzz {
namespace {

/// Every element of an accepted array can be read.
void run(std::string_view bytes) {
  const auto array = NpyArray::read(std::string(bytes));
  if (!array) return require_message(array.error(), {ErrorCode::scene_rejected});
  std::size_t size = 1;
  for (const std::size_t along : array->shape()) size *= along;
  require(size == array->size(), "an array has as many elements as its shape says");
  for (std::size_t i = 0; i < size; ++i) {
    const double number = array->number(i);
    if (array->whole_numbers())
      require(number == static_cast<double>(array->whole(i)), "a whole number is the same as a float");
  }
}

std::string file(const std::string& header, const std::string& data) {
  std::string all("\x93NUMPY\x01\x00", 8);
  all += static_cast<char>(header.size());
  all += '\0';
  return all + header + data;
}

std::vector<std::string> seeds() {
  return {file("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 1, 3), }\n", "123456"),
          file("{'descr': '<i4', 'fortran_order': True, 'shape': (1, 2), }\n", "12345678"),
          file("{'descr': '>f8', 'fortran_order': False, 'shape': (1,), }\n", "12345678"),
          file("{'descr': '|b1', 'fortran_order': False, 'shape': (), }\n", "1")};
}

std::vector<std::string> words() {
  return {
      "\x93NUMPY\x01", "\x93NUMPY\x02", "'descr': ", "'<u2'",     "'>i8'",  "'=f4'",      "'fortran_order': ",
      "True",          "False",         "'shape': ", "(1, 1, 1)", "(0, 9)", "4294967296", "-1"};
}

}  // namespace

const Target npy_target = {"npy", run, seeds, words};

}  // namespace aspic::fuzz
