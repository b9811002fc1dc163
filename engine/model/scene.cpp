// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/scene.h"

namespace cprsim {

Scene::Scene() = default;
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

RodSpec::RodSpec() = default;
RodSpec::RodSpec(const RodSpec&) = default;
RodSpec::RodSpec(RodSpec&&) noexcept = default;
RodSpec& RodSpec::operator=(const RodSpec&) = default;
RodSpec& RodSpec::operator=(RodSpec&&) noexcept = default;
RodSpec::~RodSpec() = default;

BodySpec::BodySpec() = default;
BodySpec::BodySpec(const BodySpec&) = default;
BodySpec::BodySpec(BodySpec&&) noexcept = default;
BodySpec& BodySpec::operator=(const BodySpec&) = default;
BodySpec& BodySpec::operator=(BodySpec&&) noexcept = default;
BodySpec::~BodySpec() = default;

JointSpec::JointSpec() = default;
JointSpec::JointSpec(const JointSpec&) = default;
JointSpec::JointSpec(JointSpec&&) noexcept = default;
JointSpec& JointSpec::operator=(const JointSpec&) = default;
JointSpec& JointSpec::operator=(JointSpec&&) noexcept = default;
JointSpec::~JointSpec() = default;

ProfileTerm::ProfileTerm() = default;
ProfileTerm::ProfileTerm(const ProfileTerm&) = default;
ProfileTerm::ProfileTerm(ProfileTerm&&) noexcept = default;
ProfileTerm& ProfileTerm::operator=(const ProfileTerm&) = default;
ProfileTerm& ProfileTerm::operator=(ProfileTerm&&) noexcept = default;
ProfileTerm::~ProfileTerm() = default;

SweepSpec::SweepSpec() = default;
SweepSpec::SweepSpec(const SweepSpec&) = default;
SweepSpec::SweepSpec(SweepSpec&&) noexcept = default;
SweepSpec& SweepSpec::operator=(const SweepSpec&) = default;
SweepSpec& SweepSpec::operator=(SweepSpec&&) noexcept = default;
SweepSpec::~SweepSpec() = default;

}  // namespace cprsim
