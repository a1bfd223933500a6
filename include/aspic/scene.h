#pragma once
// A scene: the physics and the image of one TOML file, as plain data; from text and back.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/inputs.h"
#include "aspic/model.h"
#include "aspic/settings.h"

namespace aspic {

/// How a camera brings the world into the image.
enum class Projection { perspective, orthographic };

/// Every one with its name in scene files.
inline constexpr Named<Projection> projections[] = {{Projection::perspective, "perspective"},
                                                    {Projection::orthographic, "orthographic"}};

/// A camera. Position and target never coincide in a scene that was accepted.
struct CameraSettings {
  Vec3 position = {10.0, 6.0, 14.0};  ///< of the eye [m]
  Vec3 target = {0.0, 2.0, 0.0};      ///< point in the middle of the image [m]
  double fov = 45.0;                  ///< vertical field of view [degrees], 1…179
  /// Orthographic: parallel to the axis, with the height that the field of view has at the target.
  Projection projection = Projection::perspective;

  friend bool operator==(const CameraSettings&, const CameraSettings&) = default;
};

/// Which parts of the bodies are drawn; `draw = ["solid"]` in a file. All false draws the terrain alone.
struct DrawSettings {
  bool solid = true;        ///< the bodies' surfaces
  bool particles = false;   ///< every particle as a point
  bool structural = false;  ///< springs, by type
  bool shear = false;       ///< diagonals of the lattice
  bool bending = false;     ///< over two cells of it

  friend bool operator==(const DrawSettings&, const DrawSettings&) = default;
};

/// Quantities that the colors of bodies show.
enum class ViewColor { material, type, strain, force, speed, signed_strain, energy, actuation };

/// Every one, in the order in which they are listed for users.
inline constexpr Named<ViewColor> view_colors[] = {
    {ViewColor::material, "material"}, {ViewColor::type, "type"},
    {ViewColor::strain, "strain"},     {ViewColor::signed_strain, "signed-strain"},
    {ViewColor::force, "force"},       {ViewColor::energy, "energy"},
    {ViewColor::speed, "speed"},       {ViewColor::actuation, "actuation"}};

/// Whether a color shows a number, on a scale.
inline bool has_scale(ViewColor color) {
  return color >= ViewColor::strain;
}

/// Whether such a number may be negative.
inline bool has_sign(ViewColor color) {
  return color == ViewColor::signed_strain || color == ViewColor::actuation;
}

/// Colors of a scale.
enum class ScaleMap { automatic, violet_yellow, heat, gray, blue_red };
/// Every one with its name in scene files.
inline constexpr Named<ScaleMap> scale_maps[] = {{ScaleMap::automatic, "automatic"},
                                                 {ScaleMap::violet_yellow, "violet-yellow"},
                                                 {ScaleMap::heat, "heat"},
                                                 {ScaleMap::gray, "gray"},
                                                 {ScaleMap::blue_red, "blue-red"}};

/// Which values the ends of a scale represent.
enum class ScaleRange { fixed, automatic, symmetric };
/// Every one with its name in scene files.
inline constexpr Named<ScaleRange> scale_ranges[] = {
    {ScaleRange::fixed, "fixed"}, {ScaleRange::automatic, "automatic"}, {ScaleRange::symmetric, "symmetric"}};

/// The scale of a color that shows a number.
struct ScaleSettings {
  ScaleMap map = ScaleMap::automatic;    ///< automatic: one that suits the quantity
  ScaleRange range = ScaleRange::fixed;  ///< fixed: `from` and `to`, or what suits the model
  /// Ends of a fixed scale, in the quantity's SI unit, strain as a ratio; absent: ends that suit the model.
  std::optional<double> from, to;

  friend bool operator==(const ScaleSettings&, const ScaleSettings&) = default;
};

/// What a cut through the bodies shows of their inside.
enum class CutInside { off, section, springs };

/// Every one, in the order in which they are listed for users.
inline constexpr Named<CutInside> cut_insides[] = {
    {CutInside::off, "off"}, {CutInside::section, "section"}, {CutInside::springs, "springs"}};

/// A plane of the world that bodies are cut along: their parts at normal·x > offset are not drawn, with the
/// unit vector along `normal`.
struct CutSettings {
  CutInside inside = CutInside::off;  ///< off: nothing is cut
  Vec3 normal = {0.0, 0.0, 1.0};      ///< of any length but zero, towards what is cut away
  double offset = 0.0;                ///< from the world's origin along the normal [m]

  bool on() const { return inside != CutInside::off; }  ///< whether anything is cut
  friend bool operator==(const CutSettings&, const CutSettings&) = default;
};

/// Which vectors are drawn as arrows; `arrows = ["contacts"]` in a file.
struct ArrowSettings {
  bool contacts = false;  ///< where particles touch terrain: normals, and the force of the contact
  bool springs = false;   ///< the sum of each particle's springs
  bool external = false;  ///< gravity, and a hand's pull
  bool net = false;       ///< all of these: f

  bool any() const { return contacts || springs || external || net; }  ///< whether any is drawn
  friend bool operator==(const ArrowSettings&, const ArrowSettings&) = default;
};

/// The `view` table of a scene.
struct ViewSettings {
  CameraSettings camera;                   ///< the eye
  bool aimed = false;                      ///< a file gave no camera: with_overrides() aims it at bodies
  DrawSettings draw;                       ///< which parts of the bodies
  ViewColor color = ViewColor::material;   ///< of the bodies
  CutSettings cut;                         ///< through the bodies
  bool terrain = true;                     ///< it is drawn; bodies touch it in either case
  bool axes = false;                       ///< the world's axes are drawn in a corner
  ArrowSettings arrows;                    ///< none by default
  std::optional<double> arrow_scale = {};  ///< an arrow's force by its length [N/m]; absent: fits the image
  ScaleSettings scale;                     ///< used by colors with has_scale()
  std::optional<double> ground;            ///< height of a ground that is drawn only [m]; absent: none
  std::optional<std::string> follow;       ///< body or ball that the camera moves along with (scene/follow.h)

  friend bool operator==(const ViewSettings&, const ViewSettings&) = default;
};

/// Names in scene files.
ASPIC_API std::string_view name_of(ViewColor color);
ASPIC_API std::string_view name_of(CutInside inside);
ASPIC_API std::string_view name_of(Projection projection);
ASPIC_API std::string_view name_of(ScaleMap map);
ASPIC_API std::string_view name_of(ScaleRange range);

/// Physics and image of one scene. Default-constructed it has no terrain and no bodies, as an empty file
/// would.
struct Scene {
  std::string name;  ///< for titles and reports; the file's name without extension if the file gives none
  std::optional<std::string> author;  ///< as videos and reports name them; absent: nobody is named
  ModelSettings model;                ///< what is simulated
  ViewSettings view;                  ///< how it is drawn
};

/// Version of the scene file format that this program reads and writes.
inline constexpr int scene_schema = 1;

/// How scenes are read.
struct LoadOptions {
  /// Memory that the scene has to fit into; absent: what the system says is available now.
  std::optional<std::uint64_t> memory_bytes = {};
  /// What messages put before a KEY=VALUE argument: the option that it was given by; empty: nothing.
  std::string origin = {};
  std::vector<std::string>* notes = nullptr;  ///< gets what was repaired in meshes; null: nobody is told
  /// Called while a mesh becomes cells, with the share that is done, 0 to 1; empty: it is not called.
  std::function<void(double)> watch = {};
};

/// Reads a scene from TOML text. Messages name `file_name`. `overrides` are KEY=VALUE arguments, later ones
/// winning; a key is a path of the parameter table with indices
/// (`cube[0].shear.stiffness`), a value is a TOML value or a bare word. Error (scene_rejected): the first
/// TOML syntax error alone, or every semantic error at once, sorted by line and separated by blank lines.
/// Each names file, line and column (or the argument) and shows the line with a caret.
ASPIC_API Result<Scene> parse_scene(std::string_view text, const std::string& file_name,
                                    std::span<const std::string> overrides = {},
                                    const LoadOptions& options = {});

/// A scene with KEY=VALUE arguments applied to it, and checked. Errors: as parse_scene; a complaint
/// that is not about an argument names the key instead of a line.
ASPIC_API Result<Scene> with_overrides(Scene scene, std::span<const std::string> overrides,
                                       const LoadOptions& options = {});

/// The same for keys of the table `view`, without its name: `color=strain`.
ASPIC_API Result<Scene> with_view(Scene scene, std::span<const std::string> arguments,
                                  const LoadOptions& options = {});

/// Reads a built-in scene by name, or else a file (write `./cube-plane` for a file with a built-in's name).
/// Errors: as parse_scene; io for a path that cannot be read; scene_rejected for a name nobody knows, with
/// the list of names and the nearest one, and for a file that is no text, a checkpoint for one.
ASPIC_API Result<Scene> load_scene(const std::string& file_or_builtin,
                                   std::span<const std::string> overrides = {},
                                   const LoadOptions& options = {});

/// A scene that is part of the program.
struct BuiltinScene {
  std::string_view name;         ///< as load_scene() takes it
  std::string_view description;  ///< one line: the file's first comment
  std::string_view group;        ///< the heading that it is listed under
};

/// All built-in scenes, in the order in which they are listed for users.
ASPIC_API std::vector<BuiltinScene> list_builtin_scenes();

/// The file of a built-in scene as it was written, comments and all; nothing for an unknown name.
ASPIC_API std::optional<std::string_view> builtin_scene_text(std::string_view name);

/// A complete scene file with every value the scene has, units as comments. Reading it back gives the same
/// values bit for bit: numbers are the shortest that do. What is absent (an infinite terrain mass,
/// restitution taken over from `contact`) stays absent and is given in a comment.
ASPIC_API std::string to_toml(const Scene& scene);

/// What a log is read for: names in it are those of the settings' bodies, indices those of their model. A log
/// that names another time step is read with_timestep() of the settings'.
struct LoggedRun {
  const ModelSettings& settings;  ///< of the scene that runs
  const Model& model;             ///< that of the settings
};

/// Reads a log. Messages name `file_name`. Error (scene_rejected): the first TOML syntax error alone, or the
/// first twenty others, sorted by line, with a caret: an unknown key, a value of another kind, steps that do
/// not ascend, and what Solver::set_inputs() refuses in double precision.
ASPIC_API Result<InputLog> parse_inputs(std::string_view text, const std::string& file_name,
                                        const LoggedRun& run);

/// Reads a file. Errors: as parse_inputs; io.
ASPIC_API Result<InputLog> read_inputs(const std::string& path, const LoggedRun& run);

/// A log as TOML: parse_inputs() of it gives the same log, to the bit. `timestep`: that of its run [s].
ASPIC_API std::string to_toml(const InputLog& log, double timestep);

}  // namespace aspic
