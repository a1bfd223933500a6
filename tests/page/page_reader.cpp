#include "page/page_reader.h"

#include <fmt/format.h>
#include <zlib.h>

namespace aspic::test {
namespace {

/// The text of the element with that id.
std::string element(const std::string& html, const std::string& id) {
  const std::size_t at = html.find("id=\"" + id + "\">");
  if (at == std::string::npos) return {};
  const std::size_t begin = html.find('>', at) + 1;
  return html.substr(begin, html.find("</script>", begin) - begin);
}

std::string from_base64(const std::string& text) {
  std::string bytes;
  unsigned word = 0, bits = 0;
  for (const char c : text) {
    const std::size_t digit =
        std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string::npos) continue;
    word = word << 6 | static_cast<unsigned>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(word >> bits & 255u);
  }
  return bytes;
}

std::string inflated(const std::string& bytes, std::string& error) {
  z_stream z = {};
  inflateInit2(&z, -15);
  std::string in = bytes, out;
  z.next_in = reinterpret_cast<Bytef*>(in.data());
  z.avail_in = static_cast<uInt>(in.size());
  int state = Z_OK;
  while (state == Z_OK) {
    const std::size_t before = out.size();
    out.resize(before + 65536);
    z.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    z.avail_out = 65536;
    state = inflate(&z, Z_NO_FLUSH);
    out.resize(before + 65536 - z.avail_out);
  }
  inflateEnd(&z);
  if (state != Z_STREAM_END || z.avail_in > 0) error = "the stream does not end where the data do";
  return out;
}

class Numbers {
 public:
  explicit Numbers(std::string bytes) : bytes_(std::move(bytes)) {}
  bool complete() const { return at_ == bytes_.size(); }
  std::string rest() { return bytes_.substr(std::exchange(at_, bytes_.size())); }
  std::vector<std::int64_t> next(std::size_t count) {
    const std::size_t planes = at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0;
    std::vector<std::int64_t> numbers(count);
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::int64_t folded = 0;
      for (std::size_t p = 0; p < planes; ++p)
        folded += std::int64_t{static_cast<unsigned char>(bytes_.at(at_ + p * count + i))} << (8 * p);
      sum += folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
      numbers[i] = sum;
    }
    at_ += planes * count;
    return numbers;
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

/// Lists of as many indices: the others are differences from the first ones.
template <std::size_t size>
std::vector<std::array<std::uint32_t, size>> lists(Numbers& numbers, std::size_t count) {
  std::vector<std::array<std::uint32_t, size>> all(count);
  for (std::size_t place = 0; place < size; ++place) {
    const auto read = numbers.next(count);
    for (std::size_t i = 0; i < count; ++i)
      all[i][place] = static_cast<std::uint32_t>(read[i] + (place > 0 ? all[i][0] : 0));
  }
  return all;
}

ReadMesh mesh_of(Numbers& numbers, const nlohmann::json& facts) {
  ReadMesh mesh;
  const auto vertices = facts["vertices"].get<std::size_t>();
  mesh.corners = lists<8>(numbers, vertices);
  const auto x = numbers.next(vertices), y = numbers.next(vertices), z = numbers.next(vertices);
  for (std::size_t v = 0; v < vertices; ++v)
    mesh.at.push_back(facts["quantum"].get<double>() *
                      Vec3{static_cast<double>(x[v]), static_cast<double>(y[v]), static_cast<double>(z[v])});
  mesh.triangles = lists<3>(numbers, facts["triangles"].get<std::size_t>());
  return mesh;
}

struct Places {
  std::size_t count = 0;
  double quantum = 0.0;
  std::vector<std::int64_t> last = {}, before = {};

  std::vector<Vec3> next(Numbers& numbers) {
    const std::vector<std::int64_t> off = numbers.next(3 * count);
    std::vector<std::int64_t> now(off);
    for (std::size_t i = 0; i < now.size() && !last.empty(); ++i) now[i] += 2 * last[i] - before[i];
    before = last.empty() ? now : last;
    last = now;
    std::vector<Vec3> places(count);
    for (std::size_t i = 0; i < count; ++i)
      places[i] = {quantum * static_cast<double>(now[i]), quantum * static_cast<double>(now[count + i]),
                   quantum * static_cast<double>(now[2 * count + i])};
    return places;
  }
};

}  // namespace

ReadPage read_page(const std::string& html) {
  ReadPage page;
  page.facts = nlohmann::json::parse(element(html, "facts"), nullptr, false);
  page.ends = nlohmann::json::parse(element(html, "ends"), nullptr, false);
  if (page.facts.is_discarded() || page.ends.is_discarded()) {
    page.error = "the facts or the ends are no JSON";
    return page;
  }
  Numbers numbers(inflated(from_base64(element(html, "data")), page.error));
  std::vector<std::array<Places, 4>> runs;
  for (const auto& run : page.facts["runs"]) {
    for (int i = 0; i < 3; ++i) numbers.next(run["listed"]);
    page.meshes.emplace_back();
    for (const auto& body : run["bodies"]) {
      if (body.contains("mesh")) page.meshes.back().push_back(mesh_of(numbers, body["mesh"]));
      std::size_t quads = 0;
      for (const auto& group : body["groups"]) quads += group.get<std::size_t>();
      if (!body.contains("mesh")) lists<4>(numbers, quads);
    }
    for (const auto& terrain : run["terrain"]) {
      if (!terrain.contains("surface")) continue;
      const auto& surface = terrain["surface"];
      numbers.next(3 * (surface["rings"].get<std::size_t>() + 1) *
                   (surface["sectors"].get<std::size_t>() + 1));
      if (terrain.contains("flat"))
        numbers.next(surface["side"].get<std::size_t>() * surface["side"].get<std::size_t>());
    }
    runs.push_back({Places{run["particles"], run["quantum"]}, Places{run["balls"].size(), run["ballQuantum"]},
                    Places{run["balls"].size(), run["spinQuantum"]},
                    Places{(run["actuated"].size() + 2) / 3, run["changeQuantum"]}});
  }
  if (page.facts.contains("live")) {
    page.start = numbers.rest();
    page.module = inflated(from_base64(element(html, "module")), page.error);
  }
  while (page.error.empty() && !numbers.complete()) {
    std::vector<ReadImage> image;
    for (auto& [particles, balls, spins, changes] : runs) {
      ReadImage read;
      read.particles = particles.next(numbers);
      read.balls = balls.next(numbers);
      read.spins = spins.next(numbers);
      if (changes.count > 0) read.changes = changes.next(numbers);
      image.push_back(std::move(read));
    }
    page.images.push_back(std::move(image));
  }
  return page;
}

}  // namespace aspic::test
