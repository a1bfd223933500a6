#pragma once
// Arrays of numbers in numpy's format .npy (numpy.lib.format, versions 1 to 3).
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace aspic {

/// An array of numbers; elements are counted in C order, whatever order the file has.
class NpyArray {
 public:
  /// Reads what np.save() wrote. Errors (scene_rejected): no such file, cut short or longer than it says;
  /// elements that are no numbers or truth values; more than 2³¹ of them, or 8 axes.
  static Result<NpyArray> read(std::string content);

  const std::vector<std::size_t>& shape() const { return shape_; }
  std::size_t size() const { return size_; }
  bool whole_numbers() const { return kind_ != 'f'; }
  /// An element of whole_numbers(); unsigned ones above the largest std::int64_t are that.
  std::int64_t whole(std::size_t i) const;
  /// An element of any kind.
  double number(std::size_t i) const;

 private:
  std::uint64_t bits(std::size_t i) const;
  std::size_t stored(std::size_t i) const;

  std::string content_;
  std::size_t data_ = 0, size_ = 0, item_ = 1;
  std::vector<std::size_t> shape_;
  char kind_ = 'u';
  bool fortran_ = false, big_endian_ = false;
};

}  // namespace aspic
