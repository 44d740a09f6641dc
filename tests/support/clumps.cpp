#include "support/clumps.hpp"

namespace eigengrain::test {

model::ClumpShape union_shape(const std::vector<Vec3>& at, const std::vector<double>& radius,
                              double density) {
  const measures::BallUnion body = measures::ball_union(at, radius);
  const measures::PrincipalAxes axes = measures::principal_axes(body.inertia);
  model::ClumpShape shape{.place = {},
                          .radius = radius,
                          .mass = density * body.volume,
                          .volume = body.volume,
                          .inertia = density * axes.inertia};
  for (const Vec3& x : at) shape.place.emplace_back(axes.orientation.conjugate() * (x - body.centre));
  return shape;
}

model::ClumpShape given_shape(std::vector<Vec3> place, std::vector<double> radius, double mass,
                              const Vec3& inertia) {
  return {
      .place = std::move(place), .radius = std::move(radius), .mass = mass, .volume = 1, .inertia = inertia};
}

model::ClumpShape dumbbell(double a) {
  return union_shape({{-a, 0, 0}, {a, 0, 0}}, {1, 1});
}

model::ClumpShape odd_shape() {
  return union_shape({{0, 0, 0}, {1.1, 0.2, 0}, {-0.2, 0.9, 0.3}, {0.1, -0.3, 1.3}}, {1, 0.8, 0.7, 0.6});
}

Quat random_orientation(std::mt19937_64& random) {
  return Quat(random_rotation(random)).normalized();
}

model::ClumpStart beside(const model::ClumpShape& first, const model::ClumpStart& start,
                         std::size_t ball_first, const model::ClumpShape& second, const Quat& orientation,
                         std::size_t ball_second, const Vec3& n, double overlap) {
  const double reach = (first.radius[ball_first] + second.radius[ball_second]) * (1 - overlap);
  return {.position = start.position + start.orientation * first.place[ball_first] + reach * n -
                      orientation * second.place[ball_second],
          .orientation = orientation};
}

SceneBuilder touching_pair(const Springs& springs, std::mt19937_64& random, double overlap) {
  const model::ClumpShape first = odd_shape();
  const model::ClumpShape second = dumbbell();
  const model::ClumpStart start{.orientation = random_orientation(random)};
  // Ball 1 sticks out; the dumbbell points away from it. Both are tilted by half a radian.
  const Vec3 out = (start.orientation * first.place[1]).normalized();
  const auto tilt = [&](const Vec3& v) {
    const Vec3 axis = v.cross(random_vector(random)).normalized();
    return Vec3(Eigen::AngleAxisd(0.5, axis) * v);
  };
  const Vec3 n = tilt(out);
  const Quat orientation(Quat::FromTwoVectors(second.place[0], -tilt(n)));
  SceneBuilder builder(springs);
  builder.clump(first, start);
  builder.clump(second, beside(first, start, 1, second, orientation.normalized(), 0, n, overlap));
  return builder;
}

Eigen::VectorXd forces_on_unknowns(const System& s, const Eigen::VectorXd& x, double h) {
  const model::Bodies& bodies = s.model.bodies;
  const auto count = bodies.position.size();
  assembly::Displacement d{std::vector<Vec3>(count, Vec3::Zero()), std::vector<Vec3>(count, Vec3::Zero())};
  for (std::int32_t block = 0; block < s.unknowns.blocks(); ++block) {
    const std::int32_t body = s.unknowns.body(block);
    Vec3 value = h * x.segment<3>(3 * block);
    const bool turns = s.unknowns.is_rotation(block);
    if (const Mat3* axes = s.unknowns.axes(body); turns && axes != nullptr) value = (*axes * value).eval();
    (turns ? d.rotation : d.translation)[static_cast<std::size_t>(body)] = value;
  }
  assembly::carry_members(bodies, d);
  assembly::BodyForces f = assembly::contact_forces(s.model, d);
  assembly::gather_members(bodies, d.rotation, f);
  Eigen::VectorXd result(x.size());
  for (std::int32_t block = 0; block < s.unknowns.blocks(); ++block) {
    const std::int32_t body = s.unknowns.body(block);
    const auto i = static_cast<std::size_t>(body);
    Vec3 value = s.unknowns.is_rotation(block) ? f.moment[i] : f.force[i];
    if (const Mat3* axes = s.unknowns.axes(body); s.unknowns.is_rotation(block) && axes != nullptr)
      value = (axes->transpose() * value).eval();
    result.segment<3>(3 * block) = value;
  }
  return result;
}

Eigen::MatrixXd numerical_stiffness(const System& s, double h) {
  const auto size = static_cast<Eigen::Index>(s.unknowns.size());
  Eigen::MatrixXd k(size, size);
  for (Eigen::Index column = 0; column < size; ++column) {
    const Eigen::VectorXd e = Eigen::VectorXd::Unit(size, column);
    k.col(column) = -(forces_on_unknowns(s, e, h) - forces_on_unknowns(s, e, -h)) / (2 * h);
  }
  return k;
}

}  // namespace eigengrain::test
