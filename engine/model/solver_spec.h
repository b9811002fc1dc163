// SPDX-License-Identifier: BSD-3-Clause
// What the scene says about how it is to be solved. Empty optionals mean: the program chooses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/model/place.h"

namespace cprsim {

enum class Mode { kStatic, kQuasistatic, kDynamic };
/// How a rod is discretised. The loader, its reference and messages take the words from here; a new
/// method adds a line to both lists, and a case in engine/rod/make_rod.cpp.
enum class Method {
  kAuto,
  kShooting,
  kStrain,
  kCollocation,
};

struct MethodWord {
  const char* word;  ///< as scenes call it
  Method method;
};

inline constexpr MethodWord kMethodWords[] = {
    {"auto", Method::kAuto},
    {"shooting", Method::kShooting},
    {"strain", Method::kStrain},
    {"collocation", Method::kCollocation},
};

const char* method_name(Method method);

enum class ArcIntegrator { kEuler, kRk4, kGauss2, kGauss4, kGauss6 };
/// Polynomials of method strain, or splines of method collocation.
enum class Basis { kLegendre, kChebyshev, kBspline, kNurbs };
enum class SchemeKind {
  kBackwardEuler,
  kBdf2,
  kBdfAlpha,
  kGeneralizedAlpha,
  kTrBdf2,
  kEsdirk32,
  kEsdirk43,
  kRadau5,
  kIda
};

/// Whether a scheme chooses its steps by itself, unless they are given.
inline bool adapts(SchemeKind kind) {
  return kind == SchemeKind::kTrBdf2 || kind == SchemeKind::kEsdirk32 ||
         kind == SchemeKind::kEsdirk43 || kind == SchemeKind::kIda;
}

enum class NonlinearAlgorithm { kLadder, kNewton, kLevenbergMarquardt };

struct SolverSpec {
  Place place;
  Method method = Method::kAuto;
  std::optional<double> accuracy;           ///< m
  std::optional<int> points;                ///< shooting: cells per rod
  std::optional<ArcIntegrator> integrator;  ///< shooting: default gauss6
  std::optional<int> order;                 ///< strain: highest degree of the polynomials
  std::optional<int> degree;                ///< collocation: of the splines
  std::optional<int> elements;              ///< strain, collocation: pieces per rod
  std::optional<Basis> basis;               ///< names for spaces of functions; see scene-format.md
  std::vector<double> weights;              ///< of nurbs
  Place space_place;                        ///< of all these
  std::optional<SchemeKind> scheme;         ///< default esdirk32
  std::optional<double> alpha, rho_inf;
  std::optional<double> step, tolerance;  ///< fixed step s; or relative local error
  NonlinearAlgorithm algorithm = NonlinearAlgorithm::kLadder;
  std::optional<double> residual_tolerance;  ///< dimensionless
  std::optional<int> max_iterations;
  bool halve_on_failure = true;
  int retries = 4;
};

struct SimulationSpec {
  Place place;
  Mode mode = Mode::kStatic;
  double duration = 0;
  bool initial_static = false;  ///< start from the static equilibrium
  unsigned seed = 0;
};

}  // namespace cprsim
