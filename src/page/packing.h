#pragma once
// How a page holds numbers: differences from what came before, whose bytes deflate well.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "aspic/vec.h"
#include "base/result.h"

namespace aspic::page {

/// Appends whole numbers as planes of bytes: a byte that says how many planes there are (0…4), then the
/// lowest byte of every number, then the next one of every number, and so on. Numbers are folded so that
/// those near 0, of either sign, have small bytes: 0, −1, 1, −2 … become 0, 1, 2, 3 …
void append_planes(std::span<const std::int32_t> numbers, std::string& bytes);

/// Appends numbers that lie near those before them: each as its difference from it, modulo 2³².
void append_differences(std::span<const std::int32_t> numbers, std::string& bytes);

/// Vectors that change from image to image, as whole multiples of a quantum. An image holds how far each
/// is from where the two images before would take it at unchanged speed, less what this is of the vector
/// before it in the list: all x, then all y, then all z. All differences are modulo 2³², so that nothing is
/// lost beyond rounding to the quantum.
class Track {
 public:
  /// `quantum` > 0, in the unit of the vectors.
  Track(std::size_t count, double quantum);

  /// Appends an image. As many vectors as `count`; a component beyond ±2²⁹ quanta is that.
  void append(std::span<const Vec3> vectors, std::string& bytes);

  double quantum() const { return quantum_; }
  /// The most that a component is off in the page, while it is within ±2²⁹ quanta.
  double error() const { return 0.5 * quantum_; }

 private:
  double quantum_;
  std::vector<std::int32_t> last_, before_, residual_;  // all x, all y, all z; of the two images before
  bool first_ = true;
};

/// A raw deflate stream (RFC 1951), made as its content comes.
class Deflater {
 public:
  /// Error (io): no memory.
  static Result<Deflater> create();
  /// What the stream has more of now; may be nothing for a while.
  Result<std::string> add(std::string_view bytes) { return pass(bytes, false); }
  /// The rest of the stream.
  Result<std::string> finish() { return pass({}, true); }

 private:
  struct Stream;
  struct End {
    void operator()(Stream* stream) const;
  };
  explicit Deflater(std::unique_ptr<Stream, End> stream) : stream_(std::move(stream)) {}
  Result<std::string> pass(std::string_view bytes, bool last);
  std::unique_ptr<Stream, End> stream_;
};

}  // namespace aspic::page
