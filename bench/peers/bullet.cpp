// Bullet's soft body, one iteration a step. It moves points of a link together by a fraction of what the link
// is too long; with the fraction h²·k·(2/m) one iteration does what a spring of stiffness k without a damper
// does in a step of symplectic Euler, except that each link sees what those before it have moved already.
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "peer.h"

namespace {

class Bullet {
 public:
  explicit Bullet(const peer::Lattice& lattice)
      : lattice_(lattice), h_(static_cast<btScalar>(lattice.timestep)) {
    const btVector3 gravity(0, -static_cast<btScalar>(lattice.gravity), 0);
    world_.setGravity(gravity);
    world_.getWorldInfo().m_gravity = gravity;
    world_.getWorldInfo().air_density = 0;
    world_.getWorldInfo().water_density = 0;
    std::vector<btVector3> rest;
    lattice.for_each_particle(1.0, [&](double x, double y, double z) { rest.push_back(vector(x, y, z)); });
    lattice.for_each_particle(lattice.stretch,
                              [&](double x, double y, double z) { start_.push_back(vector(x, y, z)); });
    const std::vector<btScalar> masses(rest.size(), static_cast<btScalar>(lattice.mass));
    body_ = new btSoftBody(&world_.getWorldInfo(), lattice.count(), rest.data(), masses.data());
    btSoftBody::Material* const material = body_->appendMaterial();
    material->m_kLST =
        static_cast<btScalar>(lattice.timestep * lattice.timestep * lattice.stiffness * 2.0 / lattice.mass);
    body_->m_links.reserve(16 * lattice.count());
    lattice.for_each_spring([&](int a, int b, double) { body_->appendLink(a, b, material); });
    body_->m_cfg.piterations = 1;
    body_->m_cfg.kDP = 0;
    body_->m_cfg.collisions = 0;
    world_.addSoftBody(body_);
    // The first step takes the rest lengths from the positions it finds: before the start is stretched.
    advance(1);
    load();
  }
  Bullet(const Bullet&) = delete;
  Bullet& operator=(const Bullet&) = delete;
  ~Bullet() {
    world_.removeSoftBody(body_);
    delete body_;
  }

  peer::Json hello() const {
    // Of a relative displacement the links of a particle take up to 32·h²k/m before one of them sees it.
    return {{"name", "bullet"},
            {"version", std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100)},
            {"threads", 1},
            {"integrator", "symplectic-euler"},
            {"damping", 0.0},
            {"deviation", 32.0 * h_ * h_ * lattice_.stiffness / lattice_.mass},
            {"velocities_from_positions", true}};
  }
  std::size_t springs() const { return static_cast<std::size_t>(body_->m_links.size()); }

  void load() {
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      btSoftBody::Node& node = body_->m_nodes[i];
      node.m_x = node.m_q = start_[static_cast<std::size_t>(i)];
      node.m_v = node.m_f = btVector3(0, 0, 0);
    }
  }

  void advance(long steps) {
    for (long n = 0; n < steps; ++n) world_.stepSimulation(h_, 0, h_);
  }

  std::vector<double> positions() const {
    std::vector<double> result;
    for (int i = 0; i < body_->m_nodes.size(); ++i) {
      const btVector3& x = body_->m_nodes[i].m_x;
      result.insert(result.end(), {x.x(), x.y(), x.z()});
    }
    return result;
  }

 private:
  static btVector3 vector(double x, double y, double z) {
    return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
  }

  peer::Lattice lattice_;
  btScalar h_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<btVector3> start_;
  btSoftBody* body_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
  return peer::converse(argc, argv, [](const peer::Lattice& lattice) { return Bullet(lattice); });
}
