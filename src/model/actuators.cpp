#include "model/actuators.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>
#include <variant>

#include "base/printable.h"
#include "model/cube.h"
#include "model/material.h"
#include "model/quad_mesh.h"
#include "model/rotation.h"
#include "model/springs.h"
#include "model/voxels.h"

namespace aspic {
namespace {

bool makes_particles(const BodyRow& row, const ModelSettings& settings) {
  return row.list.size(settings) > 0 && row.list.key != "ball" && row.list.key != "launcher";
}

std::string index_name(std::string_view list, std::size_t index) {
  return fmt::format("{}[{}]", list, index);
}

std::string_view own_name(const BodyRow& row, const ModelSettings& settings, std::size_t index) {
  return row.list.key == "voxels" ? std::string_view(settings.voxels[index].name) : std::string_view();
}

std::string excerpt_of(std::string_view text) {
  return excerpt(text, 40);
}

double cube_root(double s) {
  double x = 1.0;  // Newton's steps; from 1 they reach any root within 60
  for (int n = 0; n < 60; ++n) x = (2.0 * x + s / (x * x)) / 3.0;
  return x;
}

}  // namespace

std::optional<ListedBody> find_body(const ModelSettings& settings, std::string_view name) {
  for (const BodyRow& row : body_rows()) {
    if (!makes_particles(row, settings)) continue;
    for (std::size_t i = 0; i < row.list.size(settings); ++i) {
      const std::string_view own = own_name(row, settings, i);
      if ((!own.empty() && own == name) || index_name(row.list.key, i) == name) return ListedBody{&row, i};
    }
  }
  return std::nullopt;
}

std::vector<std::string> actuated_names(const ModelSettings& settings) {
  std::vector<std::string> names;
  for (const BodyRow& row : body_rows()) {
    if (!makes_particles(row, settings)) continue;
    for (std::size_t i = 0; i < row.list.size(settings); ++i) {
      const std::string_view own = own_name(row, settings, i);
      names.push_back(own.empty() ? index_name(row.list.key, i) : std::string(own));
    }
  }
  return names;
}

std::string actuator_name(const ModelSettings& settings, std::size_t actuator) {
  const std::string& name = settings.actuators[actuator].name;
  return name.empty() ? index_name("actuator", actuator) : name;
}

std::vector<std::string> channel_names(const ModelSettings& settings) {
  std::vector<std::string> names;
  for (std::size_t a = 0; a < settings.actuators.size(); ++a)
    if (settings.actuators[a].signal == Signal::input) names.push_back(actuator_name(settings, a));
  return names;
}

double amplitude_of(const ActuatorSettings& actuator) {
  if (!actuator.volume_change) return actuator.amplitude;
  const double v = *actuator.volume_change;
  return actuator.axis == BodyAxis::none ? cube_root(1.0 + v) - 1.0 : v;
}

std::string_view name_of(Signal signal) {
  return std::ranges::find(actuator_signals, signal, &Named<Signal>::value)->name;
}

std::optional<CellNumbers> cell_numbers(std::string_view text) {
  CellNumbers cells;
  const char *at = text.data(), *const end = text.data() + text.size();
  const auto skip = [&] {
    while (at < end && (*at == ' ' || *at == '\n' || *at == '\r')) ++at;
  };
  const auto take = [&](auto& number) {
    skip();
    const auto [stop, error] = std::from_chars(at, end, number);
    at = stop;
    return error == std::errc();
  };
  for (int& count : cells.count)
    if (!take(count) || count < 1 || count > most_cells_along) return std::nullopt;
  if (at == end || *at++ != ':') return std::nullopt;
  const std::uint64_t all = static_cast<std::uint64_t>(cells.count[0]) *
                            static_cast<std::uint64_t>(cells.count[1]) *
                            static_cast<std::uint64_t>(cells.count[2]);
  if (all > text.size()) return std::nullopt;
  for (std::uint64_t n = 0; n < all; ++n) {
    double number = 0.0;
    if (!take(number) || !std::isfinite(number)) return std::nullopt;
    cells.numbers.push_back(number);
  }
  skip();
  return at == end ? std::optional(std::move(cells)) : std::nullopt;
}

std::string to_cell_text(const CellNumbers& cells) {
  return fmt::format("{} {} {}: {}", cells.count[0], cells.count[1], cells.count[2],
                     fmt::join(cells.numbers, " "));
}

namespace {

/// Bodies that an actuator names, or all.
std::vector<std::string> bodies_of(const ModelSettings& settings, const ActuatorSettings& actuator) {
  return actuator.bodies.empty() ? actuated_names(settings) : actuator.bodies;
}

bool acts_on(const ModelSettings& settings, const ActuatorSettings& actuator, const BodyRow& row,
             std::size_t index) {
  if (!makes_particles(row, settings)) return false;
  return actuator.bodies.empty() || std::ranges::any_of(actuator.bodies, [&](const std::string& name) {
           const auto found = find_body(settings, name);
           return found && found->row->list.key == row.list.key && found->index == index;
         });
}

}  // namespace

/// A body as actuators see it.
struct ActuatedBody {
  // Of cells; nothing for cloths and nets, whose springs count as such.
  std::optional<Lattice> lattice;
  std::array<int, 3> grid = {}, offset = {};  ///< cells of the layers, and the lattice's first among them
  double size = 0.0;                          ///< edge of a cell [m]
  std::vector<std::uint8_t> material;         ///< by cell of the lattice; none: all of the first
  std::vector<std::string> names = {""};      ///< of materials
  std::vector<double> moduli = {1.0};         ///< of these, to weigh them
  Vec3 center;                                ///< [m]
  RotationSettings rotation;

  std::size_t cell_index(const Lattice::Place& cell) const {
    const std::array<int, 3> n = lattice->cells();
    return (static_cast<std::size_t>(cell[0]) * static_cast<std::size_t>(n[1]) +
            static_cast<std::size_t>(cell[1])) *
               static_cast<std::size_t>(n[2]) +
           static_cast<std::size_t>(cell[2]);
  }
  std::size_t material_of(std::size_t cell) const { return material.empty() ? 0 : material[cell]; }
  /// The middle of a cell of the lattice along an axis, in the body's frame [m].
  double middle(const Lattice::Place& cell, std::size_t axis) const {
    return size * ((cell[axis] + offset[axis]) + 0.5 - grid[axis] / 2.0);
  }
  Vec3 middle(const Lattice::Place& cell) const {
    return {middle(cell, 0), middle(cell, 1), middle(cell, 2)};
  }
};

namespace {

ActuatedBody look_at(const CubeSettings& cube) {
  ActuatedBody body;
  body.lattice = Lattice{cube.lattice(), {}};
  body.grid = body.lattice->cells();
  body.size = spacing_of(cube);
  if (cube.material) body.names = {cube.material->name};
  return body;
}

std::optional<ActuatedBody> look_at(const ModelSettings& settings, const VoxelsSettings& voxels) {
  if (fault_of(settings, voxels)) return std::nullopt;
  const auto found = shape_of(voxels);
  const auto& shape = std::get<VoxelShape>(found);
  const CellMaterials materials = materials_of(settings, voxels, shape);
  ActuatedBody body;
  body.lattice = shape.lattice;
  body.grid = shape.grid;
  body.offset = shape.offset;
  body.size = voxels.size;
  body.names.clear();
  body.moduli.clear();
  for (const MaterialSettings& each : materials.materials) {
    body.names.push_back(each.name);
    body.moduli.push_back(each.youngs_modulus);
  }
  for (const char c : shape.cells) body.material.push_back(materials.number[static_cast<std::size_t>(c)]);
  return body;
}

/// Nothing: the body cannot be made.
std::optional<ActuatedBody> look_at(const ModelSettings& settings, const BodyRow& row, std::size_t index) {
  if (row.list.key == "cube") return look_at(settings.cubes[index]);
  if (row.list.key == "voxels") return look_at(settings, settings.voxels[index]);
  ActuatedBody body;
  if (row.list.key == "cloth") {
    const ClothSettings& cloth = settings.cloths[index];
    body.center = cloth.position;
    body.rotation = cloth.rotation;
    if (cloth.material) body.names = {cloth.material->name};
  } else {
    const GoalNetSettings& net = settings.goal_nets[index];
    body.center = net.position;
    if (net.material) body.names = {net.material->name};
  }
  return body;
}

bool holds(const BoxSettings& box, const Vec3& x) {
  for (int axis = 0; axis < 3; ++axis)
    if (x[axis] < box.min[axis] || x[axis] > box.max[axis]) return false;
  return true;
}

/// All of an actuator's choice but a mask.
bool chooses(const SelectSettings& select, const std::string& material, const Vec3& middle) {
  if (!select.materials.empty() && std::ranges::find(select.materials, material) == select.materials.end())
    return false;
  return !select.box || holds(*select.box, middle);
}

bool in_mask(const CellLayers& mask, const std::array<int, 3>& at) {
  return mask.empty() || !is_empty_cell(mask[static_cast<std::size_t>(at[1])][static_cast<std::size_t>(at[2])]
                                            [static_cast<std::size_t>(at[0])]);
}

bool chooses(const SelectSettings& select, const ActuatedBody& body, const Lattice::Place& cell) {
  const std::array<int, 3> at = {cell[0] + body.offset[0], cell[1] + body.offset[1],
                                 cell[2] + body.offset[2]};
  return body.lattice->full(cell) && in_mask(select.voxels, at) &&
         chooses(select, body.names[body.material_of(body.cell_index(cell))], body.middle(cell));
}

bool chooses(const SelectSettings& select, SpringType type) {
  return select.springs.empty() || std::ranges::find(select.springs, name_of(type)) != select.springs.end();
}

/// Calls act(cell) for the cells of a lattice in their order.
template <class Act>
void for_each_cell(const Lattice& lattice, const Act& act) {
  const auto [ni, nj, nk] = lattice.cells();
  for (int i = 0; i < ni; ++i)
    for (int j = 0; j < nj; ++j)
      for (int k = 0; k < nk; ++k) act(Lattice::Place{i, j, k});
}

std::string size_text(const std::array<int, 3>& n) {
  return fmt::format("{} × {} × {}", n[0], n[1], n[2]);
}

/// The size of a mask; nothing: rows or layers differ.
std::optional<std::array<int, 3>> size_of(const CellLayers& mask) {
  if (mask.front().empty()) return std::nullopt;
  const std::size_t rows = mask.front().size(), columns = mask.front().front().size();
  for (const auto& layer : mask) {
    if (layer.size() != rows) return std::nullopt;
    for (const std::string& row : layer)
      if (row.size() != columns) return std::nullopt;
  }
  return std::array{static_cast<int>(columns), static_cast<int>(mask.size()), static_cast<int>(rows)};
}

std::optional<ActuatorFault> fault_of_signal(const ActuatorSettings& actuator) {
  double low = -1.0, high = 1.0;
  if (actuator.signal == Signal::table) {
    const SignalTable& table = actuator.table;
    if (table.size() < 2)
      return ActuatorFault{"table",
                           "a signal \"table\" needs at least two points [t, w], such as "
                           "[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]"};
    if (table.front()[0] != 0.0) return ActuatorFault{"table", "the first point's time must be 0", 0};
    for (std::size_t n = 1; n < table.size(); ++n)
      if (table[n][0] < table[n - 1][0])
        return ActuatorFault{
            "table", fmt::format("times must ascend, and {} follows {}", table[n][0], table[n - 1][0]), n};
    if (!(table.back()[0] > 0.0))
      return ActuatorFault{"table", "the last point's time, which is the table's length, must be above 0",
                           table.size() - 1};
    low = 0.0, high = 0.0;
    for (const auto& point : table) low = std::min(low, point[1]), high = std::max(high, point[1]);
  }
  const double a = amplitude_of(actuator), least = 1.0 + std::min(a * low, a * high);
  if (actuator.signal != Signal::input && least < least_stretch)
    return ActuatorFault{
        actuator.volume_change ? "volume-change" : "amplitude",
        fmt::format("rest lengths would fall to {:.4g} of their values at rest, and the minimum is {}: "
                    "choose a smaller one, or a signal that is never negative",
                    least, least_stretch)};
  if (actuator.phase.along != BodyAxis::none && actuator.phase.wavelength == 0.0)
    return ActuatorFault{
        "phase.wavelength",
        "a wavelength cannot be 0: write a positive one, or a negative one to reverse the wave"};
  return std::nullopt;
}

/// Of a mask and phases by cell, which must be as large as the layers of every body.
std::optional<ActuatorFault> fault_of_cells(const ActuatorSettings& actuator, const std::string& body,
                                            const ActuatedBody& seen) {
  const auto phases =
      actuator.phase.cells.empty() ? std::optional(CellNumbers()) : cell_numbers(actuator.phase.cells);
  if (!phases) return ActuatorFault{"phase.cells", "it is not a list of phases by cell, \"nx ny nz: …\""};
  const auto mask =
      actuator.select.voxels.empty() ? std::optional(std::array<int, 3>()) : size_of(actuator.select.voxels);
  if (!mask) return ActuatorFault{"select.voxels", "its layers and rows must be of one size"};
  const std::pair<const char*, std::optional<std::array<int, 3>>> sizes[] = {
      {"phase.cells", actuator.phase.cells.empty() ? std::nullopt : std::optional(phases->count)},
      {"select.voxels", actuator.select.voxels.empty() ? std::nullopt : mask}};
  for (const auto& [key, size] : sizes) {
    if (!size) continue;
    if (!seen.lattice) return ActuatorFault{key, fmt::format("{} has no cells; remove it", body)};
    if (*size != seen.grid)
      return ActuatorFault{key, fmt::format("it has {} cells along x, y and z, and {} has {}",
                                            size_text(*size), body, size_text(seen.grid))};
  }
  return std::nullopt;
}

}  // namespace

std::optional<ActuatorFault> fault_of(const ModelSettings& settings, std::size_t index) {
  const ActuatorSettings& actuator = settings.actuators[index];
  for (std::size_t m = 0; m < actuator.select.materials.size(); ++m)
    if (!find_material(settings, actuator.select.materials[m]))
      return ActuatorFault{
          "select.material",
          fmt::format("it names {}", unknown_material(settings, actuator.select.materials[m])), m};
  if (actuator.select.box)
    for (int axis = 0; axis < 3; ++axis)
      if (!(actuator.select.box->min[axis] <= actuator.select.box->max[axis]))
        return ActuatorFault{"select.box.min", fmt::format("its {} exceeds that of max", "xyz"[axis])};
  if (auto fault = fault_of_signal(actuator)) return fault;
  std::set<std::pair<std::string_view, std::size_t>> bodies;
  const std::vector<std::string> names = bodies_of(settings, actuator);
  bool any = names.empty();
  for (std::size_t b = 0; b < names.size(); ++b) {
    const auto found = find_body(settings, names[b]);
    if (!found)
      return ActuatorFault{"body",
                           fmt::format("there is no body \"{}\" of particles; the scene has {}",
                                       excerpt_of(names[b]), fmt::join(actuated_names(settings), ", ")),
                           b};
    if (!bodies.insert({found->row->list.key, found->index}).second)
      return ActuatorFault{"body", fmt::format("\"{}\" is listed twice", excerpt_of(names[b])), b};
    const auto body = look_at(settings, *found->row, found->index);
    if (!body) {
      any = true;  // its own check says what is wrong
      continue;
    }
    if (auto fault = fault_of_cells(actuator, names[b], *body)) return fault;
    if (!body->lattice)
      any = any || chooses(SelectSettings{.materials = actuator.select.materials}, body->names.front(), {});
    else if (!any)
      for_each_cell(*body->lattice,
                    [&](const Lattice::Place& cell) { any = any || chooses(actuator.select, *body, cell); });
  }
  if (!any)
    return ActuatorFault{"select", fmt::format("it selects no cell of {}; check its material, box and mask",
                                               fmt::join(names, ", "))};
  return std::nullopt;
}

bool is_actuated(const ModelSettings& settings, const BodyRow& row, std::size_t index) {
  return std::ranges::any_of(settings.actuators, [&](const ActuatorSettings& actuator) {
    return acts_on(settings, actuator, row, index);
  });
}

/// An actuator of the body at hand.
struct ActuationBuilder::Acting {
  std::uint32_t number;
  const ActuatorSettings* settings;
  std::vector<double> phases;              // by cell of the layers; none: 0
  std::vector<std::int64_t> phase_number;  // which of the different ones each is
};

struct ActuationBuilder::OfBody {
  ActuatedBody seen;
  std::vector<Acting> acting;
  bool one_way = false;  // an actuator stretches along an axis alone
};

ActuationBuilder::ActuationBuilder(const ModelSettings& settings) : settings_(settings) {}

/// The drive of an actuator at a place, which has the phase that the place gives it.
std::uint32_t ActuationBuilder::drive_of(std::uint32_t actuator, std::int64_t place, double phase) {
  const auto& of = settings_.actuators[actuator].phase;
  const bool everywhere = of.along == BodyAxis::none && of.cells.empty();
  const std::array<std::int64_t, 3> key = {actuator, everywhere ? -1 : std::int64_t{body_},
                                           everywhere ? 0 : place};
  const auto [at, fresh] = known_drives_.try_emplace(key, static_cast<std::uint32_t>(made_.drives.size()));
  if (fresh) made_.drives.push_back({actuator, phase});
  return at->second;
}

std::uint32_t ActuationBuilder::stretch_of(const std::vector<std::uint32_t>& drives) {
  const auto [at, fresh] =
      known_stretches_.try_emplace(drives, static_cast<std::uint32_t>(made_.stretches.size()));
  if (fresh) made_.stretches.push_back({drives});
  return at->second;
}

std::uint32_t ActuationBuilder::class_of(Model& model, const std::vector<std::int64_t>& key,
                                         const std::vector<StretchShare>& shares,
                                         const std::array<double, 3>& squares) {
  const auto [at, fresh] =
      known_classes_.try_emplace(key, static_cast<std::uint32_t>(model.spring_classes.size()));
  if (!fresh) return at->second;
  const SpringClass base = model.spring_classes[static_cast<std::size_t>(key.front())];
  model.spring_classes.push_back(base);
  made_.classes.push_back({at->second, squares, static_cast<std::uint32_t>(made_.shares.size()),
                           static_cast<std::uint32_t>(shares.size())});
  made_.shares.insert(made_.shares.end(), shares.begin(), shares.end());
  return at->second;
}

namespace {

/// Of cells around a spring those that are alike: how they stretch (−1: not at all), what they are made of.
struct Alike {
  std::int64_t stretch;
  std::int64_t material;
  std::int64_t count;
};

/// Numbers that name a spring's class for its body: those of springs that are alike are equal.
std::vector<std::int64_t> key_of(std::uint32_t base, const std::array<double, 3>& squares,
                                 std::vector<Alike>& cells) {
  std::ranges::sort(cells, {}, [](const Alike& c) { return std::pair(c.stretch, c.material); });
  std::int64_t common = 0;
  for (const Alike& c : cells) common = std::gcd(common, c.count);
  std::vector<std::int64_t> key = {base};
  for (const double square : squares) key.push_back(std::llround(square * 0x1p40));
  for (Alike& c : cells) {
    c.count /= common;
    key.insert(key.end(), {c.stretch, c.material, c.count});
  }
  return key;
}

}  // namespace

/// Springs of a lattice: each takes part of the cells that share it.
void ActuationBuilder::add_lattice(Model& model, OfBody& of, const Body& body) {
  const ActuatedBody& seen = of.seen;
  const Lattice& lattice = *seen.lattice;
  const std::array<int, 3> n = lattice.cells();
  // How cells stretch, by cell and type of spring.
  using ByType = std::array<std::int64_t, 3>;
  std::vector<ByType> stretch(
      static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]),
      ByType{-1, -1, -1});
  for_each_cell(lattice, [&](const Lattice::Place& cell) {
    std::array<std::vector<std::uint32_t>, 3> drives;
    for (const Acting& acting : of.acting) {
      const PhaseSettings& phase = acting.settings->phase;
      if (!chooses(acting.settings->select, seen, cell)) continue;
      std::int64_t place = 0;
      double at = phase.offset;
      if (phase.along != BodyAxis::none) {
        const auto axis = static_cast<std::size_t>(phase.along) - 1;
        place = cell[axis] + seen.offset[axis];
        at = at - seen.middle(cell, axis) / phase.wavelength;
      }
      if (!acting.phases.empty()) {
        const auto x = static_cast<std::size_t>(cell[0] + seen.offset[0]),
                   y = static_cast<std::size_t>(cell[1] + seen.offset[1]),
                   z = static_cast<std::size_t>(cell[2] + seen.offset[2]);
        const std::size_t number =
            (x * static_cast<std::size_t>(seen.grid[1]) + y) * static_cast<std::size_t>(seen.grid[2]) + z;
        place += acting.phase_number[number] * (most_cells_along + 1);
        at = at + acting.phases[number];
      }
      const std::uint32_t drive = drive_of(acting.number, place, at);
      for (const SpringType type : {SpringType::structural, SpringType::shear, SpringType::bending})
        if (chooses(acting.settings->select, type)) drives[static_cast<std::size_t>(type)].push_back(drive);
    }
    for (std::size_t type = 0; type < 3; ++type)
      if (!drives[type].empty()) stretch[seen.cell_index(cell)][type] = stretch_of(drives[type]);
  });

  std::vector<Lattice::Place> places;
  for (std::size_t point = 0; point < lattice.points(); ++point)
    if (const Lattice::Place place = lattice.place(point); lattice.has_particle(place))
      places.push_back(place);
  // Springs in a direction one after the other are mostly alike: what the last one was.
  std::map<std::array<int, 3>, std::pair<std::vector<std::int64_t>, std::uint32_t>> last;
  std::vector<Alike> cells;
  const auto first = std::ranges::lower_bound(model.listed_springs, body.first_particle, {}, &Spring::a);
  for (auto spring = first; spring != model.listed_springs.end(); ++spring) {
    const Lattice::Place &a = places[spring->a - body.first_particle],
                         &b = places[spring->b - body.first_particle];
    const LatticeDirection way = {b[0] - a[0], b[1] - a[1], b[2] - a[2], 0};
    const auto type = static_cast<std::size_t>(model.spring_classes[spring->spring_class].type);
    const SpringCells along = cells_along(lattice, a, way);
    cells.clear();
    bool acted = false;
    for (std::size_t c = 0; c < along.count; ++c) {
      const std::size_t index = seen.cell_index(along.at[c]);
      const auto material = static_cast<std::int64_t>(seen.material_of(index));
      const std::int64_t how = stretch[index][type];
      acted = acted || how >= 0;
      const auto same = std::ranges::find_if(
          cells, [&](const Alike& each) { return each.stretch == how && each.material == material; });
      if (same == cells.end())
        cells.push_back({how, material, 1});
      else
        ++same->count;
    }
    if (!acted) continue;
    std::array<double, 3> squares = {};
    const double whole = way.di * way.di + way.dj * way.dj + way.dk * way.dk;
    if (of.one_way) squares = {way.di * way.di / whole, way.dj * way.dj / whole, way.dk * way.dk / whole};
    std::vector<std::int64_t> key = key_of(spring->spring_class, squares, cells);
    auto& [last_key, last_class] = last[{way.di, way.dj, way.dk}];
    if (key != last_key) {
      double all = 0.0;
      for (const Alike& c : cells)
        all += static_cast<double>(c.count) * seen.moduli[static_cast<std::size_t>(c.material)];
      std::vector<StretchShare> shares;
      for (const Alike& c : cells) {
        if (c.stretch < 0) continue;
        const double share =
            static_cast<double>(c.count) * seen.moduli[static_cast<std::size_t>(c.material)] / all;
        if (!shares.empty() && shares.back().stretch == static_cast<std::uint32_t>(c.stretch))
          shares.back().share += share;
        else
          shares.push_back({static_cast<std::uint32_t>(c.stretch), share});
      }
      last_class = class_of(model, key, shares, squares);
      last_key = std::move(key);
    }
    spring->spring_class = last_class;
  }
}

/// Springs of cloths and nets, each for itself.
void ActuationBuilder::add_springs(Model& model, OfBody& of, const Body& body) {
  const Rotation back(of.seen.rotation.axis, -of.seen.rotation.angle);
  const auto own = [&](std::uint32_t particle) {
    return back(model.initial_position[particle] - of.seen.center);
  };
  // Middles and directions that differ by rounding alone are the same.
  const auto snapped = [&](double x) { return std::round(x * 0x1p20) * 0x1p-20; };
  const auto first = std::ranges::lower_bound(model.listed_springs, body.first_particle, {}, &Spring::a);
  for (auto spring = first; spring != model.listed_springs.end(); ++spring) {
    const Vec3 a = own(spring->a), b = own(spring->b), e = b - a;
    const Vec3 exact = 0.5 * (a + b);
    const Vec3 middle = {snapped(exact.x), snapped(exact.y), snapped(exact.z)};
    const SpringType type = model.spring_classes[spring->spring_class].type;
    std::vector<std::uint32_t> drives;
    for (const Acting& acting : of.acting) {
      const ActuatorSettings& actuator = *acting.settings;
      if (!chooses(actuator.select, type) || !chooses(actuator.select, of.seen.names.front(), middle))
        continue;
      const PhaseSettings& phase = actuator.phase;
      const double x = phase.along == BodyAxis::none ? 0.0 : middle[static_cast<int>(phase.along) - 1];
      drives.push_back(
          drive_of(acting.number, std::llround(x * 0x1p20),
                   phase.along == BodyAxis::none ? phase.offset : phase.offset - x / phase.wavelength));
    }
    if (drives.empty()) continue;
    std::array<double, 3> squares = {};
    if (const double whole = dot(e, e); of.one_way && whole > 0.0)
      squares = {snapped(e.x * e.x / whole), snapped(e.y * e.y / whole), snapped(e.z * e.z / whole)};
    const std::uint32_t stretch = stretch_of(drives);
    std::vector<Alike> cells = {{stretch, 0, 1}};
    const std::vector<std::int64_t> key = key_of(spring->spring_class, squares, cells);
    spring->spring_class = class_of(model, key, {{stretch, 1.0}}, squares);
  }
}

void ActuationBuilder::add_body(Model& model, const BodyRow& row, std::size_t index) {
  OfBody of;
  for (std::size_t a = 0; a < settings_.actuators.size(); ++a) {
    const ActuatorSettings& actuator = settings_.actuators[a];
    if (!acts_on(settings_, actuator, row, index)) continue;
    Acting acting = {static_cast<std::uint32_t>(a), &actuator, {}, {}};
    if (auto phases = cell_numbers(actuator.phase.cells)) {
      std::map<double, std::int64_t> known;
      for (const double phase : phases->numbers)
        acting.phase_number.push_back(
            known.try_emplace(phase, static_cast<std::int64_t>(known.size())).first->second);
      acting.phases = std::move(phases->numbers);
    }
    of.acting.push_back(std::move(acting));
    of.one_way = of.one_way || actuator.axis != BodyAxis::none;
  }
  if (of.acting.empty()) return;
  auto body_seen = look_at(settings_, row, index);
  if (!body_seen) return;  // it could not have been added
  of.seen = *std::move(body_seen);
  Body& body = model.bodies.back();
  known_classes_.clear();
  if (const Lattice* const box = body.box()) {
    const std::vector<Spring> springs = springs_of(*box, body.first_particle, body.first_class);
    model.listed_springs.insert(model.listed_springs.end(), springs.begin(), springs.end());
    const std::array<int, 3> n = box->cells();
    body.lattice->full_cells.assign(
        static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]),
        true);
    body.listed_surface = surface_of(*body.lattice, body.first_particle);
  }
  if (of.seen.lattice)
    add_lattice(model, of, body);
  else
    add_springs(model, of, body);
  body.class_count = static_cast<std::uint32_t>(model.spring_classes.size()) - body.first_class;
  ++body_;
}

void ActuationBuilder::finish(Model& model) {
  for (std::size_t a = 0; a < settings_.actuators.size(); ++a) {
    const ActuatorSettings& s = settings_.actuators[a];
    made_.actuators.push_back({actuator_name(settings_, a), s.axis, amplitude_of(s), s.signal, s.frequency,
                               s.signal == Signal::table ? s.table : SignalTable(), s.start, s.ramp,
                               made_.channels});
    if (s.signal == Signal::input) ++made_.channels;
  }
  model.actuation = std::move(made_);
}

}  // namespace aspic
