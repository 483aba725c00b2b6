#include "tests/bench/bullet_body.h"

#ifdef PHRENIC_BULLET
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace phrenic::bench {

struct BulletBody::World {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::unique_ptr<btSoftBody> body;
};

BulletBody::BulletBody(const Points& x, const Eigen::VectorXd& inverse_mass, const std::vector<Spring>& springs,
                       int iterations)
    : world_(std::make_unique<World>()) {
  world_->world.setGravity(btVector3(0, 0, 0));
  world_->world.getWorldInfo().m_gravity = btVector3(0, 0, 0);
  btAlignedObjectArray<btVector3> points;
  btAlignedObjectArray<btScalar> masses;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    points.push_back(
        btVector3(static_cast<btScalar>(x(0, i)), static_cast<btScalar>(x(1, i)), static_cast<btScalar>(x(2, i))));
    masses.push_back(inverse_mass[i] > 0 ? static_cast<btScalar>(1 / inverse_mass[i]) : btScalar(0));
  }
  world_->body = std::make_unique<btSoftBody>(&world_->world.getWorldInfo(), points.size(), &points[0], &masses[0]);
  btSoftBody& body = *world_->body;
  body.m_materials[0]->m_kLST = btScalar(0.5);
  for (const Spring& spring : springs) body.appendLink(spring.a, spring.b, body.m_materials[0]);
  body.m_cfg.piterations = iterations;
  body.m_cfg.collisions = 0;
  world_->world.addSoftBody(&body);
}

BulletBody::~BulletBody() { world_->world.removeSoftBody(world_->body.get()); }

void BulletBody::Step(double dt) { world_->world.stepSimulation(static_cast<btScalar>(dt), 0); }

}  // namespace phrenic::bench
#endif
