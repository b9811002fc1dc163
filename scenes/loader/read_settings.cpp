// SPDX-License-Identifier: BSD-3-Clause
// Gravity, physics, solver, effects, mode and duration.
#include <cmath>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

double number_of(const Node* node, double fallback) {
  return node ? parse_number(node->text, true).value_or(fallback) : fallback;
}

bool flag_of(const Node* node, bool fallback) {
  return node ? parse_bool(node->text).value_or(fallback) : fallback;
}

Vec3 vec3_of(const Node* node, const Vec3& fallback) {
  return node ? parse_vec3(node->text).value_or(fallback) : fallback;
}

std::optional<double> optional_number(const Node& node, std::string_view key) {
  const Attribute* a = node.attribute(key);
  return a ? parse_number(a->value) : std::nullopt;
}

double number_attribute(const Node& node, std::string_view key, double fallback) {
  return optional_number(node, key).value_or(fallback);
}

std::string mean(const std::string& name) {
  return name.empty() ? name : "did you mean " + name + "?";
}

const Node* chosen_physics(const Node& world) {
  const std::vector<const Node*> all = world.all("physics");
  for (const Node* node : all)
    if (parse_bool(node->value("default")).value_or(false)) return node;
  return all.empty() ? nullptr : all.front();
}

namespace {

constexpr int kMostPoints = 10'000;
// beyond these a rod has more unknowns than its dense equations can be solved with in a second
constexpr int kHighestOrder = 40, kMostElements = 400;
// of splines: below, positions and forces would not be smooth; above, engine/math/bspline.h ends
constexpr int kLowestDegree = 2, kHighestDegree = 8;
constexpr double kMostSteps = 1e8;

std::optional<int> optional_count(const Node& node, std::string_view key) {
  const Attribute* a = node.attribute(key);
  const auto value = a ? parse_integer(a->value) : std::nullopt;
  return value ? std::optional<int>(static_cast<int>(*value)) : std::nullopt;
}

template <class Value>
struct Word {
  const char* word;
  Value value;
};

template <class Value, std::size_t N>
std::optional<Value> choose(const Word<Value> (&words)[N], std::string_view text) {
  for (const auto& entry : words)
    if (entry.word == text) return entry.value;
  return std::nullopt;
}

constexpr Word<ArcIntegrator> kIntegrators[] = {{"euler", ArcIntegrator::kEuler},
                                                {"rk4", ArcIntegrator::kRk4},
                                                {"gauss2", ArcIntegrator::kGauss2},
                                                {"gauss4", ArcIntegrator::kGauss4},
                                                {"gauss6", ArcIntegrator::kGauss6}};
constexpr Word<Basis> kBases[] = {{"legendre", Basis::kLegendre},
                                  {"chebyshev", Basis::kChebyshev},
                                  {"bspline", Basis::kBspline},
                                  {"nurbs", Basis::kNurbs}};
constexpr Word<SchemeKind> kSchemes[] = {{"backward_euler", SchemeKind::kBackwardEuler},
                                         {"bdf2", SchemeKind::kBdf2},
                                         {"bdf_alpha", SchemeKind::kBdfAlpha},
                                         {"generalized_alpha", SchemeKind::kGeneralizedAlpha},
                                         {"tr_bdf2", SchemeKind::kTrBdf2},
                                         {"esdirk32", SchemeKind::kEsdirk32},
                                         {"esdirk43", SchemeKind::kEsdirk43},
                                         {"radau5", SchemeKind::kRadau5},
                                         {"ida", SchemeKind::kIda}};

void read_weights(Reading& r, const Node& node) {
  const Attribute* weights = node.attribute("weights");
  if (!weights) return;
  SolverSpec& solver = r.scene.solver;
  if (solver.basis != Basis::kNurbs || !solver.degree || !solver.elements) {
    r.report.bad_value("E310", node, *weights, "weights are those of a basis of known size",
                       "basis=\"nurbs\", with degree and elements");
    return;
  }
  solver.weights = parse_numbers(weights->value).value_or(std::vector<double>{});
  const int functions = *solver.degree + *solver.elements;
  if (solver.weights.size() != static_cast<std::size_t>(functions))
    r.report.bad_value("E306", node, *weights,
                       std::to_string(functions) +
                           " weights belong to the functions of this degree on these elements");
  for (const double weight : solver.weights)
    if (!(weight > 0)) {
      r.report.bad_value("E306", node, *weights, "weights are positive");
      return;
    }
}

void read_space(Reading& r, const Node& node) {
  SolverSpec& solver = r.scene.solver;
  solver.space_place = node.place;
  const auto count = [&](const char* key, int most, int least = 1) {
    const auto value = optional_count(node, key);
    if (value && *value > most)
      r.report.bad_value("E509", node, *node.attribute(key),
                         std::string(key) + " is at most " + std::to_string(most));
    if (value && *value < least)
      r.report.bad_value("E509", node, *node.attribute(key),
                         std::string(key) + " is at least " + std::to_string(least));
    return value;
  };
  solver.points = count("points", kMostPoints);
  solver.integrator = choose(kIntegrators, node.value("integrator"));
  solver.basis = choose(kBases, node.value("basis"));
  solver.order = count("order", kHighestOrder);
  solver.degree = count("degree", kHighestDegree, kLowestDegree);
  solver.elements = count("elements", kMostElements);
  read_weights(r, node);
}

void in_range(Reading& r, const Node& node, const char* key, double low, double high) {
  const auto value = optional_number(node, key);
  if (value && (*value < low || *value > high))
    r.report.bad_value(
        "E306", node, *node.attribute(key),
        std::string(key) + " lies between " + format_number(low) + " and " + format_number(high));
}

// a parameter that the chosen scheme does not have would be dropped silently
void belongs(Reading& r, const Node& node, const char* key, std::string_view scheme) {
  if (node.attribute(key) && node.value("scheme") != scheme)
    r.report.bad_value("E310", node, *node.attribute(key),
                       std::string(key) + " belongs to " + std::string(scheme) + ", not to " +
                           std::string(node.value("scheme")));
}

void read_time(Reading& r, const Node& node) {
  SolverSpec& solver = r.scene.solver;
  solver.scheme = choose(kSchemes, node.value("scheme"));
  in_range(r, node, "alpha", -0.5, 0);
  in_range(r, node, "rho_inf", 0, 1);
  in_range(r, node, "tolerance", 1e-12, 0.1);
  belongs(r, node, "alpha", "bdf_alpha");
  belongs(r, node, "rho_inf", "generalized_alpha");
  solver.alpha = optional_number(node, "alpha");
  solver.rho_inf = optional_number(node, "rho_inf");
  solver.step = optional_number(node, "step");
  solver.tolerance = optional_number(node, "tolerance");
  if (solver.step && solver.scheme == SchemeKind::kIda)
    r.report.bad_value("E310", node, *node.attribute("step"),
                       "ida chooses its steps: give tolerance");
  if (solver.tolerance && solver.scheme && !adapts(*solver.scheme))
    r.report.bad_value("E310", node, *node.attribute("tolerance"),
                       std::string(node.value("scheme")) + " takes fixed steps: give step");
  if (solver.step && solver.tolerance)
    r.report.error("E310", node, "step fixes the time step, tolerance adapts it: give one of them");
}

void read_solver(Reading& r, const Node& node) {
  SolverSpec& solver = r.scene.solver;
  solver.place = node.place;
  solver.method = method_attribute(node).value_or(Method::kAuto);
  if (const Node* accuracy = node.child("accuracy")) {
    solver.accuracy = number_of(accuracy, 0);
    const bool distances = !accuracy->attribute("of");
    if (*solver.accuracy < 1e-12 || (distances && *solver.accuracy > 1))
      r.report.bad_text(
          "E306", *accuracy,
          distances ? "accuracy lies between 1e-12 and 1 m" : "accuracy is 1e-12 or more");
  }
  if (const Node* space = node.child("space")) read_space(r, *space);
  if (const Node* time = node.child("time")) read_time(r, *time);
  if (const Node* nonlinear = node.child("nonlinear")) {
    in_range(r, *nonlinear, "tolerance", 1e-14, 1e-2);
    solver.residual_tolerance = optional_number(*nonlinear, "tolerance");
    solver.max_iterations = optional_count(*nonlinear, "max_iterations");
    const std::string_view algorithm = nonlinear->value("algorithm");
    if (algorithm == "newton") solver.algorithm = NonlinearAlgorithm::kNewton;
    if (algorithm == "levenberg_marquardt" || algorithm == "dogleg")
      solver.algorithm = NonlinearAlgorithm::kLevenbergMarquardt;
    if (algorithm == "dogleg")
      r.report.note("W592", *nonlinear,
                    "dogleg: the step within a trust region is found by Levenberg-Marquardt's "
                    "damping, of which a dogleg is the approximation");
  }
  if (const Node* failure = node.child("on_failure")) {
    in_range(r, *failure, "retries", 0, 100);
    solver.halve_on_failure = failure->value("action") != "stop";
    solver.retries = optional_count(*failure, "retries").value_or(solver.retries);
  }
}

void read_effects(Reading& r, const Node& node) {
  for (const auto& child : node.children)
    for (int k = 0; k < kEffectCount; ++k) {
      const auto effect = static_cast<Effect>(k);
      if (!child->broken && child->name == effect_name(effect))
        r.scene.effects.set(effect, true, child->place);
    }
}

void override_effects(Reading& r) {
  std::vector<std::string> names;
  for (int k = 0; k < kEffectCount; ++k)
    names.emplace_back(effect_name(static_cast<Effect>(k)));
  const auto apply = [&](const std::vector<std::string>& list, bool on) {
    const std::string option = on ? "--with " : "--without ";
    for (const std::string& word : list) {
      bool known = false;
      for (int k = 0; k < kEffectCount; ++k) {
        const auto effect = static_cast<Effect>(k);
        if (word != effect_name(effect)) continue;
        known = true;
        r.scene.effects.set(effect, on, r.scene.effects.asked_at[static_cast<std::size_t>(k)]);
      }
      if (known) continue;
      Diagnostic& d =
          r.report.at(Severity::kError, "E307", {}, 0, option + word + ": there is no such effect");
      d.suggestion = mean(nearest_name(word, names));
    }
  };
  apply(r.options.with, true);
  apply(r.options.without, false);
}

void read_plane(Reading& r, const Node& node) {
  const Attribute* normal = node.attribute("normal");
  const auto value = normal ? parse_vec3(normal->value) : std::nullopt;
  if (!value) return;
  if (value->norm() < 1e-9)
    r.report.bad_value("E506", node, *normal, "the plane's normal has length 0");
  else
    r.scene.planar_normal = value->normalized();
}

void read_simulation(Reading& r, const Node& node) {
  SimulationSpec& simulation = r.scene.simulation;
  simulation.place = node.place;
  const std::string_view mode = node.value("mode");
  simulation.mode = mode == "dynamic"       ? Mode::kDynamic
                    : mode == "quasistatic" ? Mode::kQuasistatic
                                            : Mode::kStatic;
  simulation.duration = number_of(node.child("duration"), 0);
  if (const Node* seed = node.child("seed"))
    simulation.seed = static_cast<unsigned>(parse_integer(seed->text).value_or(0));
  if (const Node* planar = node.child("planar")) read_plane(r, *planar);
  if (const Node* initial = node.child("initial"))
    simulation.initial_static = initial->value("solve") == "static";
  if (simulation.mode != Mode::kStatic && simulation.duration <= 0 && !node.broken &&
      !node.child("duration")) {
    bool given = false;
    for (const auto& child : node.children)
      given = given || child->name == "duration";
    if (!given)
      r.report.missing("E507", node, "a " + std::string(mode) + " simulation needs a <duration>");
  }
}

void check_step(Reading& r, const Node& where) {
  const Scene& scene = r.scene;
  if (scene.simulation.mode == Mode::kStatic || scene.simulation.duration <= 0) return;
  const double step = scene.solver.step.value_or(scene.max_step_size);
  if (scene.simulation.duration / step > kMostSteps)
    r.report.error("E509", where,
                   "a duration of " + format_number(scene.simulation.duration) + " s in steps of " +
                       format_number(step) + " s is more than 1e8 steps");
  if (step > scene.simulation.duration)
    r.report.warn("W504", where,
                  "the time step, " + format_number(step) + " s, is longer than the duration, " +
                      format_number(scene.simulation.duration) + " s");
}

}  // namespace

std::optional<Method> method_attribute(const Node& node) {
  for (const MethodWord& each : kMethodWords)
    if (each.word == node.value("method")) return each.method;
  return std::nullopt;
}

void read_settings(Reading& r, const Node& world) {
  r.scene.name = world.value("name");
  r.scene.gravity = vec3_of(world.child("gravity"), r.scene.gravity);
  if (const Node* wind = world.child("wind"))
    r.scene.wind = vec3_of(wind->child("linear_velocity"), r.scene.wind);
  const Node* physics = chosen_physics(world);
  if (physics) {
    r.scene.max_step_size = number_of(physics->child("max_step_size"), r.scene.max_step_size);
    if (const Node* solver = physics->child("cprsim:solver")) read_solver(r, *solver);
  }
  if (const Node* effects = world.child("cprsim:effects")) read_effects(r, *effects);
  override_effects(r);
  bool given = false;
  for (const auto& child : world.children)
    given = given || child->name == "cprsim:simulation";
  if (const Node* simulation = world.child("cprsim:simulation"))
    read_simulation(r, *simulation);
  else if (!given)
    r.report.missing(
        "E507", world,
        describe(world) + " has no <cprsim:simulation>: static, quasistatic or dynamic?");
  check_step(r, physics ? *physics : world);
}

}  // namespace cprsim
