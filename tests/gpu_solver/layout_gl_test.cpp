#include <gtest/gtest.h>

#include "gpu/program.h"
#include "gpu/shader_source.h"
#include "gpu_solver/layout.h"
#include "gpu_solver/step_inputs.h"
#include "model/terrain.h"
#include "support/gl_fixture.h"
#include "support/program_reflection.h"

namespace aspic {
namespace {

using aspic::testing::Reflection;

class Layout : public aspic::testing::GlTest {
 protected:
  static gl::Program program(const char* path) {
    auto made = gl::Program::compute(context(), gl::ShaderLibrary(), path);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
    return std::move(made).value();
  }
  static int bytes(std::size_t count) { return static_cast<int>(count); }
};

#define EXPECT_UNIFORM_AT(member) \
  EXPECT_EQ(Reflection(p).uniform_offset(#member), bytes(offsetof(layout::Simulation, member)))

// Members a kernel does not use may be inactive; sum_springs uses all but the spring classes, gather has
// those.
TEST_F(Layout, UniformBlockMatchesTheDriver) {
  const gl::Program p = program("compute/gather.comp");
  EXPECT_EQ(Reflection(p).uniform_block_binding("Simulation"), BINDING_SIMULATION);
  EXPECT_EQ(Reflection(p).uniform_block_data_size("Simulation"), bytes(sizeof(layout::Simulation)));
  EXPECT_UNIFORM_AT(gravity);
  EXPECT_UNIFORM_AT(contact_distance);
  EXPECT_UNIFORM_AT(resting_speed);
  EXPECT_UNIFORM_AT(step_scale);
  EXPECT_UNIFORM_AT(divergence_speed_squared);
  EXPECT_UNIFORM_AT(particle_count);
  EXPECT_UNIFORM_AT(terrain_count);
  EXPECT_UNIFORM_AT(contact_model);
  EXPECT_UNIFORM_AT(class_bits);
  EXPECT_UNIFORM_AT(drift);
  EXPECT_UNIFORM_AT(ball_count);
  EXPECT_UNIFORM_AT(stages[0].advance);
  EXPECT_UNIFORM_AT(stages[0].weight);
  EXPECT_UNIFORM_AT(stages[0].accumulate);
  EXPECT_UNIFORM_AT(stages[0].last);
  EXPECT_UNIFORM_AT(stages[3].last);
  EXPECT_UNIFORM_AT(spring_classes[0].stiffness);
  EXPECT_UNIFORM_AT(spring_classes[0].damping);
  EXPECT_UNIFORM_AT(spring_classes[0].rest_length);
  EXPECT_UNIFORM_AT(spring_classes[255].cord);
  EXPECT_UNIFORM_AT(terrains[0].geometry[0]);
  EXPECT_UNIFORM_AT(terrains[0].mass);
  EXPECT_UNIFORM_AT(terrains[0].restitution);
  EXPECT_UNIFORM_AT(terrains[0].friction);
  EXPECT_UNIFORM_AT(terrains[0].movable);
  EXPECT_UNIFORM_AT(terrains[63].shape);
}

TEST_F(Layout, PullBlockMatchesTheDriver) {
  for (const char* path : {"compute/gather.comp", "compute/sum_springs.comp", "compute/implicit_begin.comp",
                           "compute/implicit_evaluate.comp", "compute/implicit_apply.comp"}) {
    const gl::Program p = program(path);
    EXPECT_EQ(Reflection(p).uniform_block_binding("PullBlock"), BINDING_PULLS) << path;
    EXPECT_EQ(Reflection(p).uniform_block_data_size("PullBlock"), bytes(pull_table_bytes)) << path;
    EXPECT_EQ(Reflection(p).uniform_offset("pulls[0].anchor"), 16) << path;
    EXPECT_EQ(Reflection(p).uniform_offset("pulls[0].stiffness"),
              bytes(16 + offsetof(layout::Pull, stiffness)))
        << path;
    EXPECT_EQ(Reflection(p).uniform_offset("pulls[0].damping"), bytes(16 + offsetof(layout::Pull, damping)))
        << path;
    EXPECT_EQ(Reflection(p).uniform_offset("pulls[0].particle"), bytes(16 + offsetof(layout::Pull, particle)))
        << path;
  }
}

TEST_F(Layout, StorageBlocksMatchTheDriver) {
  const gl::Program gather = program("compute/gather.comp");
  EXPECT_EQ(Reflection(gather).storage_block_binding("StartState"), BINDING_START_STATE);
  EXPECT_EQ(Reflection(gather).storage_block_binding("StageState"), BINDING_STAGE_STATE);
  EXPECT_EQ(Reflection(gather).storage_block_binding("OutState"), BINDING_OUT_STATE);
  EXPECT_EQ(Reflection(gather).storage_block_binding("StageSums"), BINDING_STAGE_SUMS);
  EXPECT_EQ(Reflection(gather).storage_block_binding("IncidentStart"), BINDING_INCIDENT_START);
  EXPECT_EQ(Reflection(gather).storage_block_binding("Incident"), BINDING_INCIDENT);
  EXPECT_EQ(Reflection(gather).storage_block_binding("ControlBlock"), BINDING_CONTROL);
  EXPECT_EQ(Reflection(gather).storage_block_data_size("ControlBlock"), bytes(sizeof(layout::Control)));
  EXPECT_EQ(Reflection(gather).buffer_variable_offset("control.bad_step"),
            bytes(offsetof(layout::Control, bad_step)));
  EXPECT_EQ(Reflection(gather).buffer_variable_offset("control.bad_particle"),
            bytes(offsetof(layout::Control, bad_particle)));
  for (const char* block : {"start_state", "stage_state", "out_state", "stage_sums"}) {
    const std::string name(block);
    EXPECT_EQ(Reflection(gather).buffer_variable_offset(name + "[0].position"), 0) << name;
    EXPECT_EQ(Reflection(gather).buffer_variable_offset(name + "[0].velocity"),
              bytes(offsetof(layout::Particle, velocity)))
        << name;
    EXPECT_EQ(Reflection(gather).buffer_variable_top_level_stride(name + "[0].velocity"),
              bytes(sizeof(layout::Particle)))
        << name;
  }
  const gl::Program forces = program("compute/spring_forces.comp");
  EXPECT_EQ(Reflection(forces).storage_block_binding("Springs"), BINDING_SPRINGS);
  EXPECT_EQ(Reflection(forces).buffer_variable_array_stride("springs[0]"), bytes(sizeof(layout::uvec2)));
  EXPECT_EQ(Reflection(forces).storage_block_binding("SpringForces"), BINDING_SPRING_FORCES);
  EXPECT_EQ(Reflection(forces).buffer_variable_array_stride("spring_forces[0]"), bytes(sizeof(layout::vec4)));
}

TEST_F(Layout, LatticesMatchTheDriver) {
  const std::vector<gl::Define> defines = {{"ASPIC_LATTICES", "1"}, {"ASPIC_LISTED", "1"}};
  for (const char* path : {"compute/gather.comp", "compute/implicit_apply.comp", "render/quantity.comp"}) {
    const bool render = std::string_view(path).starts_with("render");
    const auto p = gl::Program::compute(context(), gl::ShaderLibrary(), path,
                                        render ? std::span<const gl::Define>{} : std::span(defines));
    ASSERT_TRUE(p.ok()) << p.error().message();
    EXPECT_EQ(Reflection(*p).uniform_block_binding("Lattices"), BINDING_LATTICES) << path;
    EXPECT_EQ(Reflection(*p).uniform_block_data_size("Lattices"), bytes(sizeof(layout::Lattices))) << path;
    EXPECT_EQ(Reflection(*p).uniform_offset("lattice_count"), 0) << path;
    EXPECT_EQ(Reflection(*p).uniform_offset("lattices[0].first_particle"),
              bytes(offsetof(layout::Lattices, lattices)))
        << path;
  }
}

TEST_F(Layout, CellsMatchTheDriver) {
  for (const char* kind : {"ASPIC_MIXED", "ASPIC_WIDE_LOADS"}) {
    const std::vector<gl::Define> defines = {
        {"ASPIC_LATTICES", "1"}, {"ASPIC_LATTICE_RUN", "1"}, {kind, "1"}};
    const auto p = gl::Program::compute(context(), gl::ShaderLibrary(), "compute/cells.comp", defines);
    ASSERT_TRUE(p.ok()) << p.error().message();
    EXPECT_EQ(Reflection(*p).storage_block_binding("CellWords"), BINDING_CELLS);
    EXPECT_EQ(Reflection(*p).uniform_block_binding("Cells"), BINDING_CELL_BODIES);
    EXPECT_EQ(Reflection(*p).uniform_block_data_size("Cells"), bytes(sizeof(layout::Cells)));
    EXPECT_EQ(Reflection(*p).uniform_offset("cell_bodies[0].first_class"),
              bytes(offsetof(layout::Cells, cell_bodies) + offsetof(layout::CellBody, first_class)));
  }
}

TEST_F(Layout, BallBlocksMatchTheDriver) {
  const gl::Program fly = program("compute/ball_fly.comp");
  EXPECT_EQ(Reflection(fly).storage_block_binding("Balls"), BINDING_BALLS);
  EXPECT_EQ(Reflection(fly).storage_block_binding("BallBodies"), BINDING_BALL_BODIES);
  EXPECT_EQ(Reflection(fly).buffer_variable_offset("balls[0].velocity"),
            bytes(offsetof(layout::Ball, velocity)));
  EXPECT_EQ(Reflection(fly).buffer_variable_offset("balls[0].spin"), bytes(offsetof(layout::Ball, spin)));
  EXPECT_EQ(Reflection(fly).buffer_variable_offset("balls[0].start_velocity"),
            bytes(offsetof(layout::Ball, start_velocity)));
  EXPECT_EQ(Reflection(fly).buffer_variable_top_level_stride("balls[0].spin"), bytes(sizeof(layout::Ball)));
  EXPECT_EQ(Reflection(fly).buffer_variable_offset("bodies[0].launch_step"),
            bytes(offsetof(layout::BallBody, launch_step)));
  EXPECT_EQ(Reflection(fly).buffer_variable_top_level_stride("bodies[0].launch_step"),
            bytes(sizeof(layout::BallBody)));
  const gl::Program exchange = program("compute/ball_exchange.comp");
  EXPECT_EQ(Reflection(exchange).storage_block_binding("StateA"), BINDING_STATE_A);
  EXPECT_EQ(Reflection(exchange).storage_block_binding("StateB"), BINDING_STATE_B);
  EXPECT_EQ(Reflection(exchange).storage_block_binding("ContactsBlock"), BINDING_BALL_CONTACTS);
  EXPECT_EQ(Reflection(exchange).storage_block_binding("ItemsBlock"), BINDING_BALL_ITEMS);
  EXPECT_EQ(Reflection(exchange).storage_block_binding("WorkBlock"), BINDING_BALL_WORK);
  EXPECT_EQ(Reflection(exchange).buffer_variable_offset("contacts[0].items"),
            bytes(offsetof(layout::BallContacts, items)));
  EXPECT_EQ(Reflection(exchange).buffer_variable_top_level_stride("contacts[0].list"),
            bytes(sizeof(layout::BallContacts)));
  EXPECT_EQ(Reflection(exchange).buffer_variable_offset("items[0].overlaps[0]"),
            bytes(offsetof(layout::BallItem, overlaps)));
  EXPECT_EQ(Reflection(exchange).buffer_variable_offset("items[0].turning"),
            bytes(offsetof(layout::BallItem, turning)));
  EXPECT_EQ(Reflection(exchange).buffer_variable_top_level_stride("items[0].turning"),
            bytes(sizeof(layout::BallItem)));
  EXPECT_EQ(Reflection(exchange).buffer_variable_offset("lists[0]"), bytes(sizeof(layout::BallWork)));
  const gl::Program near = program("compute/ball_near.comp");
  EXPECT_EQ(Reflection(near).uniform_location("sought"), LOCATION_BALL_KIND);
  EXPECT_EQ(Reflection(exchange).uniform_location("ball_phase"), LOCATION_BALL_PHASE);
  EXPECT_EQ(Reflection(exchange).uniform_location("ball_parity"), LOCATION_BALL_PARITY);
  EXPECT_EQ(Reflection(exchange).uniform_offset("ball_restitution"),
            bytes(offsetof(layout::Simulation, ball_restitution)));
  EXPECT_EQ(Reflection(exchange).uniform_offset("ball_friction"),
            bytes(offsetof(layout::Simulation, ball_friction)));
  const gl::Program insert = program("compute/ball_insert.comp");
  EXPECT_EQ(Reflection(insert).storage_block_binding("BallGrid"), BINDING_BALL_GRID);
  EXPECT_EQ(Reflection(insert).uniform_offset("bucket_mask"),
            bytes(offsetof(layout::Simulation, bucket_mask)));
  const gl::Program clear = program("compute/ball_clear.comp");
  EXPECT_EQ(Reflection(clear).uniform_offset("mark_shift"), bytes(offsetof(layout::Simulation, mark_shift)));
  EXPECT_EQ(Reflection(clear).buffer_variable_offset("work.item_groups[0]"),
            bytes(offsetof(layout::BallWork, item_groups)));
}

TEST_F(Layout, UniformLocationsAndBlockCounts) {
  for (const char* path : {"compute/gather.comp", "compute/sum_springs.comp"}) {
    const gl::Program p = program(path);
    EXPECT_EQ(Reflection(p).uniform_location("step_index"), LOCATION_STEP);
    EXPECT_EQ(Reflection(p).uniform_location("stage_index"), LOCATION_STAGE);
    EXPECT_LE(Reflection(p).storage_block_count(), gl::max_storage_blocks);
  }
}

}  // namespace
}  // namespace aspic
