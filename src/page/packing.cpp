#include "page/packing.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

namespace aspic::page {
namespace {

/// Of a middle between speed and size; 9 makes files 2 % smaller in three times the time.
constexpr int level = 6;
constexpr double most_quanta = 0x1p29;

/// a − b modulo 2³².
std::int32_t less(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

std::uint32_t folded(std::int32_t number) {
  return (static_cast<std::uint32_t>(number) << 1) ^ static_cast<std::uint32_t>(number >> 31);
}

}  // namespace

void append_planes(std::span<const std::int32_t> numbers, std::string& bytes) {
  std::uint32_t all = 0;
  for (const std::int32_t number : numbers) all |= folded(number);
  const int planes = (std::bit_width(all) + 7) / 8;
  bytes += static_cast<char>(planes);
  for (int plane = 0; plane < planes; ++plane)
    for (const std::int32_t number : numbers)
      bytes += static_cast<char>(folded(number) >> (8 * plane) & 0xffu);
}

void append_differences(std::span<const std::int32_t> numbers, std::string& bytes) {
  std::vector<std::int32_t> differences(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    differences[i] = i > 0 ? less(numbers[i], numbers[i - 1]) : numbers[i];
  append_planes(differences, bytes);
}

Track::Track(std::size_t count, double quantum)
    : quantum_(quantum), last_(3 * count), before_(3 * count), residual_(3 * count) {
  assert(quantum > 0.0);
}

void Track::append(std::span<const Vec3> vectors, std::string& bytes) {
  assert(3 * vectors.size() == last_.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const double components[] = {vectors[i].x, vectors[i].y, vectors[i].z};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = c * vectors.size() + i;
      const auto now = static_cast<std::int32_t>(
          std::lround(std::clamp(components[c] / quantum_, -most_quanta, most_quanta)));
      const std::int32_t speed = less(last_[at], before_[at]);
      residual_[at] = less(less(now, last_[at]), speed);
      before_[at] = std::exchange(last_[at], now);
    }
  }
  // The first image has no speed before it: its places count as those of the image before, too.
  if (std::exchange(first_, false)) before_ = last_;
  append_differences(residual_, bytes);
}

struct Deflater::Stream {
  z_stream z = {};
};

void Deflater::End::operator()(Stream* stream) const {
  deflateEnd(&stream->z);
  delete stream;
}

Result<Deflater> Deflater::create() {
  auto stream = std::make_unique<Stream>();
  constexpr int raw = -15, memory = 9;
  if (deflateInit2(&stream->z, level, Z_DEFLATED, raw, memory, Z_DEFAULT_STRATEGY) != Z_OK)
    return Error{ErrorCode::io, "Cannot compress a page: not enough memory."};
  return Deflater(std::unique_ptr<Stream, End>(stream.release()));
}

Result<std::string> Deflater::pass(std::string_view bytes, bool last) {
  z_stream& z = stream_->z;
  std::string out;
  constexpr std::size_t piece = 1u << 16;
  // zlib counts in 32 bits, and takes its input as if it changed it.
  for (std::size_t at = 0;;) {
    const std::size_t size = std::min<std::size_t>(bytes.size() - at, 1u << 30);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + at));
    z.avail_in = static_cast<uInt>(size);
    at += size;
    const bool ends = last && at == bytes.size();
    do {
      const std::size_t before = out.size();
      out.resize(before + piece);
      z.next_out = reinterpret_cast<Bytef*>(out.data() + before);
      z.avail_out = piece;
      deflate(&z, ends ? Z_FINISH : Z_NO_FLUSH);
      out.resize(before + piece - z.avail_out);
    } while (z.avail_out == 0);
    if (at == bytes.size()) return out;
  }
}

}  // namespace aspic::page
