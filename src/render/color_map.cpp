#include "render/color_map.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

constexpr int map_size = 256;
constexpr double pi = 3.14159265358979323846;

bool in_gamut(const Color& c) {
  return std::ranges::all_of(c, [](float v) { return v >= 0.0f && v <= 1.0f; });
}

Oklab polar(double lightness, double chroma, double hue_degrees) {
  const double hue = hue_degrees * pi / 180.0;
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

/// The nearest color of this lightness and hue that the sRGB gamut holds.
Oklab within_gamut(double lightness, double chroma, double hue_degrees) {
  while (!in_gamut(from_oklab(polar(lightness, chroma, hue_degrees)))) chroma *= 0.995;
  return polar(lightness, chroma, hue_degrees);
}

/// The path of a scale from t = 0 to 1: lightness and hue run straight, chroma is as large as the gamut
/// allows within a cap that keeps the path smooth.
Oklab path(ScaleMap map, double t) {
  if (map == ScaleMap::heat)
    return within_gamut(0.13 + 0.80 * t, 0.20 * std::sin(pi * std::min(0.06 + 0.85 * t, 1.0)),
                        15.0 + 90.0 * t);
  if (map == ScaleMap::gray) return polar(0.16 + 0.78 * t, 0.0, 0.0);
  if (map == ScaleMap::blue_red) {
    // Each half runs straight between its end and the gray in the middle.
    const double out = std::abs(2.0 * t - 1.0);
    return polar(0.93 - 0.45 * out, 0.165 * out, t < 0.5 ? 258.0 : 27.0);
  }
  return within_gamut(0.27 + 0.64 * t, 0.085 + 0.05 * std::sin(pi * t) + 0.06 * t, 305.0 - 200.0 * t);
}

double distance(const Oklab& a, const Oklab& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Color encoded(double r, double g, double b) {
  return {static_cast<float>(srgb_to_linear(r)), static_cast<float>(srgb_to_linear(g)),
          static_cast<float>(srgb_to_linear(b))};
}

}  // namespace

std::array<float, 4> with_alpha(const Color& c, double alpha) {
  return {c[0], c[1], c[2], static_cast<float>(alpha)};
}

double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

Color from_oklab(const Oklab& lab) {
  const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3.0);
  const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3.0);
  const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3.0);
  return {static_cast<float>(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          static_cast<float>(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          static_cast<float>(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

std::vector<std::byte> color_map_texels(ScaleMap map) {
  // Equal steps along the path's length, not along its parameter.
  constexpr int fine = 4096;
  std::vector<double> length(fine + 1, 0.0);
  Oklab before = path(map, 0.0);
  for (int i = 1; i <= fine; ++i) {
    const Oklab here = path(map, static_cast<double>(i) / fine);
    length[static_cast<std::size_t>(i)] = length[static_cast<std::size_t>(i) - 1] + distance(before, here);
    before = here;
  }
  std::vector<std::byte> texels;
  for (int i = 0; i < map_size; ++i) {
    const double wanted = length.back() * i / (map_size - 1);
    const auto above = std::ranges::lower_bound(length, wanted);
    const double t = static_cast<double>(above - length.begin()) / fine;
    const Color color = from_oklab(path(map, std::min(t, 1.0)));
    for (const float channel : color) {
      const double value = linear_to_srgb(std::clamp(static_cast<double>(channel), 0.0, 1.0));
      texels.push_back(static_cast<std::byte>(std::lround(255.0 * value)));
    }
    texels.push_back(std::byte{255});
  }
  return texels;
}

ScaleMap chosen_map(const ViewSettings& view) {
  if (view.scale.map != ScaleMap::automatic) return view.scale.map;
  return has_sign(view.color) ? ScaleMap::blue_red : ScaleMap::violet_yellow;
}

Color spring_color(SpringType type) {
  static const Color colors[] = {encoded(0.05, 0.85, 0.90), encoded(0.98, 0.85, 0.10),
                                 encoded(0.16, 0.78, 0.22)};
  return colors[static_cast<std::size_t>(type)];
}

Color body_color(std::size_t body) {
  static const std::array<Color, 8> palette = {encoded(0.93, 0.22, 0.30), encoded(0.35, 0.80, 0.30),
                                               encoded(0.98, 0.62, 0.16), encoded(0.30, 0.52, 0.95),
                                               encoded(0.72, 0.36, 0.90), encoded(0.15, 0.78, 0.74),
                                               encoded(0.96, 0.42, 0.66), encoded(0.90, 0.84, 0.22)};
  return palette[body % palette.size()];
}

Color neutral_body_color() {
  return encoded(0.80, 0.81, 0.83);
}

}  // namespace aspic
