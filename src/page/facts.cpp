#include "page/facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/base64.h"
#include "model/counts.h"
#include "model/skin_text.h"
#include "model/springs.h"
#include "model/terrain.h"
#include "page/terrain_shape.h"
#include "render/body_painter.h"
#include "render/color_map.h"
#include "render/overlay_text.h"
#include "render/quantity.h"
#include "scene/follow.h"

namespace aspic::page {
namespace {

/// Of a length. Four times as coarse makes a large page half as long; a small one is short anyway.
double finest(const Model& model) {
  return model.particle_count() <= 10000 ? 1.0 / 4096.0 : 1.0 / 1024.0;
}

Json triple(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Json spring_class(const SpringClass& s) {
  return {{"type", name_of(s.type)},
          {"k", s.stiffness},
          {"c", s.damping},
          {"r", s.rest_length},
          {"cord", s.cord}};
}

Json body_facts(const Model& model, std::size_t index) {
  const Body& body = model.bodies[index];
  Json groups = Json::array(), rods = Json::array();
  if (body.skin.empty())
    for (const NormalGroup& group : surface_of(body).groups) groups.push_back(group.quads);
  for (const Rod& r : body.rods)
    rods.push_back({r.from.x, r.from.y, r.from.z, r.to.x, r.to.y, r.to.z, r.radius});
  constexpr std::string_view styles[] = {"flesh", "sheet", "cords"};
  Json facts = {{"first", body.first_particle},
                {"count", body.particle_count},
                {"firstClass", body.first_class},
                {"lattice", body.box() ? Json(body.box()->particles) : Json()},
                {"style", styles[static_cast<std::size_t>(body.style)]},
                {"reach", light_reach(body)},
                {"color", body_color(index)},
                {"groups", groups},
                {"rods", rods}};
  if (!body.skin.empty())
    facts["mesh"] = {{"vertices", body.skin.corners.size()},
                     {"triangles", body.skin.triangles.size()},
                     {"quantum", 1.0 / skin_steps}};
  return facts;
}

/// Lists of as many indices: all first ones, then all second ones as differences from those, and so on.
template <class List>
void append_lists(const std::vector<List>& lists, std::string& bytes) {
  for (std::size_t place = 0; place < List().size(); ++place) {
    std::vector<std::int32_t> numbers;
    for (const List& list : lists)
      numbers.push_back(static_cast<std::int32_t>(place == 0 ? list[0] : list[place] - list[0]));
    append_differences(numbers, bytes);
  }
}

void append_mesh(const BodySkin& skin, std::string& bytes) {
  append_lists(skin.corners, bytes);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::int32_t> steps;
    for (const SkinVertex& vertex : skin.binding.vertices)
      steps.push_back(static_cast<std::int32_t>(std::lround(vertex.at[axis] * skin_steps)));
    append_differences(steps, bytes);
  }
  append_lists(skin.triangles, bytes);
}

Json terrain_facts(const Terrain& terrain) {
  const TerrainShapeRow& row = terrain_row(terrain.shape);
  Json facts = {{"title", row.title}, {"glass", row.glass}, {"place", triple(terrain.geometry.vectors[0])}};
  if (row.ball) facts["radius"] = terrain.geometry.numbers[0];
  if (row.flat) {
    const FlatPart flat = row.flat(terrain.geometry);
    facts["flat"] = {{"point", triple(flat.point)}, {"normal", triple(flat.normal)}};
  }
  if (row.surface) facts["surface"] = surface_facts(terrain);
  if (terrain.motion)
    facts["motion"] = {{"along", triple(terrain.motion->amplitude * terrain.motion->direction)},
                       {"frequency", terrain.motion->frequency},
                       {"phase", terrain.motion->phase}};
  return facts;
}

Json ranges_of(const Model& model, const ViewSettings& view) {
  Json ranges = Json::object();
  for (const auto& [color, name] : view_colors) {
    if (!has_scale(color) || (color == ViewColor::actuation && model.actuation.empty())) continue;
    // The scene's own ends are of the color that it chose.
    QuantityRange range = default_range(model, color);
    if (color == view.color && view.scale.range == ScaleRange::fixed) range = range_for(model, view, range);
    ranges[name] = range;
  }
  return ranges;
}

Json map_text(ScaleMap map) {
  std::string rgb;
  const auto texels = color_map_texels(map);
  for (std::size_t i = 0; i < texels.size(); ++i)
    if (i % 4 != 3) rgb += static_cast<char>(texels[i]);
  return base64(rgb);
}

}  // namespace

Quanta quanta_of(const Model& model) {
  double spacing = std::numeric_limits<double>::infinity(), radius = spacing;
  for (const SpringClass& s : model.spring_classes) spacing = std::min(spacing, s.rest_length);
  for (const Ball& ball : model.balls) radius = std::min(radius, ball.radius);
  const double share = finest(model);
  const auto quantum = [&](double length) { return std::isfinite(length) ? share * length : share; };
  return {quantum(spacing), quantum(radius), 1.0 / 256.0, 1.0 / 8192.0};
}

Json run_facts(const Scene& scene, const Model& model, const std::string& name, std::size_t number) {
  const Quanta quanta = quanta_of(model);
  Json parameters = Json::array();
  for (const OverlayLine& line : overlay_lines(scene, 0.0))
    if (line.label != "time" && line.label != "author") parameters.push_back({line.label, line.value});
  Json classes = Json::array(), bodies = Json::array(), balls = Json::array(), terrain = Json::array();
  for (const SpringClass& s : model.spring_classes) classes.push_back(spring_class(s));
  for (std::size_t i = 0; i < model.bodies.size(); ++i) bodies.push_back(body_facts(model, i));
  const bool footballs = std::ranges::any_of(model.bodies, &Body::footballs);
  for (std::size_t i = 0; i < model.balls.size(); ++i)
    balls.push_back(
        {{"radius", model.balls[i].radius},
         {"launch", model.balls[i].launch_step},
         {"color", footballs ? Color{0.86f, 0.86f, 0.84f} : body_color(model.bodies.size() + i)}});
  for (const Terrain& t : model.terrain) terrain.push_back(terrain_facts(t));
  Json directions = Json::array();
  for (const LatticeDirection& d : lattice_directions())
    directions.push_back({d.di, d.dj, d.dk, d.spring_class});
  double spacing = std::numeric_limits<double>::infinity();
  for (const SpringClass& s : model.spring_classes) spacing = std::min(spacing, s.rest_length);
  Json actuated = Json::array();
  for (const ActuatedClass& c : model.actuation.classes) actuated.push_back(c.spring_class);
  Json facts = {{"name", name},
                {"number", number},
                {"timestep", model.simulation.timestep},
                {"parameters", parameters},
                {"particles", model.particle_count()},
                {"springs", spring_count(model)},
                {"listed", model.listed_springs.size()},
                {"quantum", quanta.position},
                {"ballQuantum", quanta.ball_position},
                {"spinQuantum", quanta.spin},
                {"spacing", std::isfinite(spacing) ? spacing : 1.0},
                {"classes", classes},
                {"actuated", actuated},
                {"changeQuantum", quanta.change},
                {"directions", directions},
                {"bodies", bodies},
                {"balls", balls},
                {"terrain", terrain},
                {"ranges", ranges_of(model, scene.view)}};
  if (scene.view.follow) {
    if (const auto followed = find_followed(scene.model, *scene.view.follow)) {
      const State start = initial_state(model, Precision::single);
      facts["follow"] = {{"ball", followed->ball},
                         {"index", followed->index},
                         {"start", triple(place_of(model, start, *followed))}};
    }
  }
  return facts;
}

Json view_facts(const Scene& scene) {
  const ViewSettings& view = scene.view;
  const CameraSettings& camera = view.camera;
  Json facts = {{"position", triple(camera.position)},
                {"target", triple(camera.target)},
                {"fov", camera.fov},
                {"orthographic", camera.projection == Projection::orthographic},
                {"color", name_of(view.color)},
                {"terrain", view.terrain},
                {"axes", view.axes},
                {"draw",
                 {{"solid", view.draw.solid},
                  {"particles", view.draw.particles},
                  {"structural", view.draw.structural},
                  {"shear", view.draw.shear},
                  {"bending", view.draw.bending}}}};
  if (view.ground) facts["ground"] = *view.ground;
  const bool own = view.scale.map != ScaleMap::automatic;
  facts["scale"] = map_text(own ? view.scale.map : ScaleMap::violet_yellow);
  facts["signedScale"] = map_text(own ? view.scale.map : ScaleMap::blue_red);
  Json types = Json::object();  // a null value that becomes one aborts without memory
  for (const SpringType type : {SpringType::structural, SpringType::shear, SpringType::bending})
    types[name_of(type)] = spring_color(type);
  facts["springColors"] = types;
  facts["neutral"] = neutral_body_color();
  return facts;
}

std::vector<Vec3> changes_of(const Model& model, std::uint64_t step, std::span<const double> channels) {
  const std::vector<double> lengths = rest_lengths(model, step, 0.0, channels);
  const std::vector<ActuatedClass>& classes = model.actuation.classes;
  std::vector<Vec3> changes(change_vectors(model));
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const std::uint32_t c = classes[i].spring_class;
    changes[i / 3][static_cast<int>(i % 3)] = lengths[c] / model.spring_classes[c].rest_length - 1.0;
  }
  return changes;
}

void append_shapes(const Model& model, std::string& bytes) {
  std::vector<std::int32_t> first, reach, classes;
  for (const Spring& s : model.listed_springs) {
    first.push_back(static_cast<std::int32_t>(s.a));
    reach.push_back(static_cast<std::int32_t>(s.b - s.a));
    classes.push_back(static_cast<std::int32_t>(s.spring_class));
  }
  append_differences(first, bytes);
  append_differences(reach, bytes);
  append_differences(classes, bytes);
  for (const Body& body : model.bodies) {
    if (body.skin.empty()) {
      append_lists(surface_of(body).quads, bytes);
    } else {
      append_mesh(body.skin, bytes);
    }
  }
  for (const Terrain& t : model.terrain)
    if (terrain_row(t.shape).surface) append_surface(t, bytes);
}

}  // namespace aspic::page
