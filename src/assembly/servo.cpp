#include "eigengrain/assembly/servo.hpp"

#include "eigengrain/assembly/forces.hpp"

#include <algorithm>
#include <cmath>

namespace eigengrain::assembly {
namespace {

/// Sum of the stiffness of the acting contacts of each wall [wall_count], N/m.
std::vector<Mat3> wall_stiffness(const Model& model) {
  std::vector<Mat3> result(model.wall_count(), Mat3::Zero());
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    if constexpr (!Kinematics::second_is_body) {
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        const contact::ContactMotion motion =
            contact::at_rest(Kinematics::geometry(placement, group.pairs[c]));
        if (!group.law.acts(motion, group.states[c])) continue;
        result[static_cast<std::size_t>(Kinematics::wall(placement, group.pairs[c]))] +=
            group.law.stiffness(motion, group.states[c]).translation(motion.normal);
      }
    }
  });
  return result;
}

}  // namespace

std::vector<double> servo_speeds(const Model& model, double dt) {
  std::vector<double> speeds(model.wall_motions.size(), 0.0);
  const auto has_servo = [](const model::WallMotion& motion) { return motion.servo.has_value(); };
  if (std::none_of(model.wall_motions.begin(), model.wall_motions.end(), has_servo)) return speeds;
  const std::vector<WallLoad> loads = wall_loads(model);
  const std::vector<Mat3> stiffness = wall_stiffness(model);
  for (std::size_t m = 0; m < speeds.size(); ++m) {
    if (!has_servo(model.wall_motions[m])) continue;
    const model::Servo& servo = *model.wall_motions[m].servo;
    const auto wall = static_cast<std::size_t>(model.wall_motions[m].wall);
    const double missing = servo.force + loads[wall].force.dot(servo.direction);
    const double k = servo.direction.dot(stiffness[wall] * servo.direction);
    speeds[m] = k > 0 ? std::clamp(servo.relaxation * missing / (k * dt), -servo.max_speed, servo.max_speed)
                      : std::copysign(servo.max_speed, missing);
  }
  return speeds;
}

}  // namespace eigengrain::assembly
