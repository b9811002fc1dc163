// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/weigh.h"

#include "engine/model/mass_properties.h"
#include "scenes/loader/values.h"

namespace cprsim {
namespace {

constexpr double kWater = 1000;  ///< kg/m³, SDFormat's default

MassProperties part(Reading& r, const Node& node, const Pose& X_BS, const ShapeSpec& shape,
                    double density) {
  if (shape.kind == ShapeKind::kMesh && shape.mesh >= 0 &&
      !encloses_solid(r.scene.meshes[static_cast<std::size_t>(shape.mesh)]))
    r.report.error("E502", node,
                   "the mesh of " + describe(node) + " is not closed: it has no volume to weigh",
                   "write mass and inertia, or use a closed mesh");
  return seen_from(X_BS, mass_properties(shape, r.scene.meshes, density));
}

}  // namespace

bool computes_inertia(const Node& inertial) {
  return parse_bool(inertial.value("auto")).value_or(false);
}

void weigh(Reading& r, const Node& link, const Node& inertial, BodySpec& body) {
  for (const char* name : {"inertia", "pose"})
    if (const Node* other = inertial.child(name))
      r.report.error("E310", *other, "<" + std::string(name) + "> is computed where auto=\"true\"",
                     "leave one of them out");
  const double density = number_of(inertial.child("density"), kWater);
  MassProperties whole;
  const auto collisions = link.all("collision"), visuals = link.all("visual");
  for (std::size_t i = 0; i < body.colliders.size(); ++i)
    whole = joined(whole, part(r, *collisions[i], body.colliders[i].X_BC, body.colliders[i].shape,
                               number_of(collisions[i]->child("density"), density)));
  if (body.colliders.empty())
    for (std::size_t i = 0; i < body.visuals.size(); ++i)
      whole =
          joined(whole, part(r, *visuals[i], body.visuals[i].X_BV, body.visuals[i].shape, density));
  if (whole.mass <= 0) {
    if (!r.report.failed())
      r.report.error("E501", inertial, describe(link) + " has no shape with a volume to weigh",
                     "write mass and inertia, or give it a <collision>");
    return;
  }
  const double mass = number_of(inertial.child("mass"), whole.mass);
  body.mass = mass;
  body.com = whole.com;
  body.inertia = mass / whole.mass * whole.inertia;
}

}  // namespace cprsim
