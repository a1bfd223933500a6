#include "io/zip_writer.h"

#include <zlib.h>

#include <algorithm>
#include <concepts>
#include <limits>

namespace aspic {
namespace {

constexpr std::uint16_t zip_version = 45, unix_version = (3 << 8) | zip_version, utf8_names = 1 << 11;
constexpr std::uint32_t in_extra = 0xffffffffu;             // a 64-bit number follows elsewhere
constexpr std::uint32_t first_date = (1u << 5 | 1u) << 16;  // 1980-01-01, 00:00: the same bytes every time

/// Little-endian numbers, one after the other.
class Record {
 public:
  template <std::unsigned_integral T>
  Record& add(T number) {
    for (std::size_t byte = 0; byte < sizeof(T); ++byte)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * byte) & 0xffu);
    return *this;
  }
  Record& add(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::uint16_t u16(std::size_t number) {
  return static_cast<std::uint16_t>(number);
}

}  // namespace

std::uint32_t crc_of(std::string_view bytes, std::uint32_t before) {
  uLong sum = before;
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max());
    sum = crc32(sum, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(size));
    bytes.remove_prefix(size);
  }
  return static_cast<std::uint32_t>(sum);
}

std::uint32_t joined_crc_of(std::uint32_t first, std::uint32_t second, std::uint64_t size) {
  return static_cast<std::uint32_t>(crc32_combine(first, second, static_cast<z_off_t>(size)));
}

Status ZipWriter::begin(const std::string& name, std::uint64_t size, std::uint32_t sum) {
  members_.push_back({name, size, offset_, sum});
  Record head;
  head.add(std::uint32_t{0x04034b50}).add(zip_version).add(utf8_names).add(std::uint16_t{0}).add(first_date);
  head.add(sum).add(in_extra).add(in_extra).add(u16(name.size())).add(std::uint16_t{20}).add(name);
  head.add(std::uint16_t{1}).add(std::uint16_t{16}).add(size).add(size);
  return write(head.bytes());
}

Status ZipWriter::write(std::string_view bytes) {
  offset_ += bytes.size();
  return file_.write(bytes);
}

Status ZipWriter::finish() {
  const std::uint64_t table = offset_;
  for (const Member& m : members_) {
    Record row;
    row.add(std::uint32_t{0x02014b50})
        .add(unix_version)
        .add(zip_version)
        .add(utf8_names)
        .add(std::uint16_t{0});
    row.add(first_date).add(m.checksum).add(in_extra).add(in_extra).add(u16(m.name.size()));
    row.add(std::uint16_t{28}).add(std::uint16_t{0}).add(std::uint16_t{0}).add(std::uint16_t{0});
    row.add(std::uint32_t{0100644} << 16).add(in_extra).add(m.name);
    row.add(std::uint16_t{1}).add(std::uint16_t{24}).add(m.size).add(m.size).add(m.offset);
    ASPIC_CHECK(write(row.bytes()));
  }
  const std::uint64_t end = offset_, count = members_.size();
  Record tail;
  tail.add(std::uint32_t{0x06064b50}).add(std::uint64_t{44}).add(unix_version).add(zip_version);
  tail.add(std::uint32_t{0}).add(std::uint32_t{0}).add(count).add(count).add(end - table).add(table);
  tail.add(std::uint32_t{0x07064b50}).add(std::uint32_t{0}).add(end).add(std::uint32_t{1});
  tail.add(std::uint32_t{0x06054b50}).add(std::uint16_t{0}).add(std::uint16_t{0}).add(std::uint16_t{0xffff});
  tail.add(std::uint16_t{0xffff}).add(in_extra).add(in_extra).add(std::uint16_t{0});
  return write(tail.bytes());
}

}  // namespace aspic
