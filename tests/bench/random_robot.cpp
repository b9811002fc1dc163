// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/random_robot.h"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>

#include "scenes/loader/values.h"

namespace cprsim {
namespace {

/// Random numbers by the standard's fixed engine alone: its distributions differ between libraries.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  double within(double most) { return most * (2 * unit() - 1); }

  /// Evenly distributed in the logarithm.
  double between(double least, double most) { return least * std::pow(most / least, unit()); }

  int below(int count) { return static_cast<int>(unit() * count); }

  bool one_in(int count) { return below(count) == 0; }

  const char* of(std::initializer_list<const char*> words) {
    return words.begin()[below(static_cast<int>(words.size()))];
  }

 private:
  std::mt19937_64 engine_;
};

std::string number(double x) {
  return format_number(x);
}

std::string vector(double x, double y, double z) {
  return number(x) + " " + number(y) + " " + number(z);
}

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : dice_(seed) {}

  RandomRobot write() {
    choose();
    for (int i = 0; i < robot_.rods; ++i)
      write_leg(i);
    const std::string plate = has_plate_ ? plate_link() : "";
    robot_.text =
        "<?xml version=\"1.0\"?>\n<sdf version=\"1.11\" xmlns:cprsim=\"urn:cprsim:1\">\n"
        "<world name=\"random\">\n" +
        settings() +
        "<model name=\"robot\">\n<link name=\"base\"/>\n"
        "<joint name=\"ground\" type=\"fixed\"><parent>world</parent><child>base</child>"
        "</joint>\n" +
        plate + bodies_ + joints_ + rods_ + "</model>\n" + obstacles() + "</world>\n</sdf>\n";
    return robot_;
  }

 private:
  void choose() {
    robot_.rods = 1 + dice_.below(12);
    robot_.mode = dice_.of({"static", "quasistatic", "dynamic", "dynamic"});
    robot_.contact = dice_.one_in(3);
    robot_.method = dice_.of({"auto", "shooting", "strain", "collocation"});
    radius_ = dice_.between(1e-4, 2e-2);
    length_ = radius_ * dice_.between(10, 1e5);
    youngs_modulus_ = dice_.between(1e3, 4e11);
    density_ = dice_.between(500, 1e4);
    step_ = dice_.between(1e-5, 5e-2);
    end_ = 10 * step_;
    has_plate_ = true;
  }

  std::string settings() {
    std::string out = "<physics name=\"p\" type=\"bullet\"><max_step_size>" + number(step_) +
                      "</max_step_size>\n<cprsim:solver method=\"" + robot_.method + "\">";
    if (dice_.one_in(3)) out += element("accuracy", number(1e-4 * length_));
    if (robot_.mode == "dynamic") {
      robot_.adaptive = dice_.one_in(2);
      const std::string steps =
          robot_.adaptive ? "tolerance=\"1e-5\"" : "step=\"" + number(step_) + "\"";
      const char* scheme =
          robot_.adaptive
              ? dice_.of({"esdirk32", "esdirk43", "tr_bdf2"})
              : dice_.of({"esdirk32", "bdf_alpha", "generalized_alpha", "backward_euler", "bdf2"});
      out += std::string("<time scheme=\"") + scheme + "\" " + steps + "/>";
    }
    out += "</cprsim:solver></physics>\n<cprsim:simulation mode=\"" + robot_.mode + "\">";
    if (robot_.mode != "static") out += element("duration", number(end_));
    if (robot_.mode == "dynamic" && dice_.one_in(2)) out += "<initial solve=\"static\"/>";
    out += "</cprsim:simulation>\n<cprsim:effects>";
    if (dice_.one_in(2)) out += "<gravity/>";
    const int strains = dice_.below(4);
    if (strains == 1 || strains == 3) out += "<extension/>";
    if (strains >= 2) out += "<shear/>";
    if (dice_.one_in(4)) out += "<rotary_inertia/>";
    if (damped_) out += "<damping/>";
    if (robot_.contact) out += dice_.one_in(2) ? "<contact/><friction/>" : "<contact/>";
    return out + "</cprsim:effects>\n";
  }

  std::string inertial(double mass, double size) {
    const std::string I = number(0.4 * mass * size * size);
    return "<inertial><mass>" + number(mass) + "</mass><inertia><ixx>" + I + "</ixx><iyy>" + I +
           "</iyy><izz>" + I + "</izz></inertia></inertial>";
  }

  double rod_mass() const { return density_ * std::numbers::pi * radius_ * radius_ * length_; }

  std::string plate_link() {
    return "<link name=\"plate\"><pose>" + plate_pose_ + "</pose>" +
           inertial(rod_mass() * dice_.between(1e-2, 1e2), 0.2 * length_) + "</link>\n";
  }

  /// A carriage between the ground and a leg: driven, or passive with a spring.
  void write_carriage(int i, const std::string& pose) {
    const std::string name = "carriage_" + std::to_string(i), joint = "guide_" + std::to_string(i);
    bodies_ += "<link name=\"" + name + "\"><pose>" + pose + "</pose>" +
               inertial(rod_mass() * dice_.between(0.1, 10), 0.1 * length_) + "</link>\n";
    const std::string type = dice_.of({"prismatic", "revolute", "continuous", "screw", "universal",
                                       "ball", "cylindrical", "planar"});
    const bool own = type == "cylindrical" || type == "planar";
    const std::string tag = own ? "cprsim:joint" : "joint";
    const double I = std::numbers::pi / 4 * std::pow(radius_, 4);
    const double stiffness = youngs_modulus_ * I / std::pow(length_, 3);  // N/m
    const bool slides = type == "prismatic";
    const bool driven = (slides || type == "revolute" || type == "continuous") && dice_.one_in(2);
    const std::string spring =
        "<dynamics><spring_stiffness>" +
        number(stiffness * dice_.between(0.1, 100) * (slides ? 1 : length_ * length_)) +
        "</spring_stiffness></dynamics>";
    const char* x = dice_.of({"1 0 0", "0 1 0", "0 0 1"});
    std::string axes;
    if (type == "universal" || type == "planar") {
      axes = "<axis><xyz>1 0 0</xyz>" + spring + "</axis><axis2><xyz>0 1 0</xyz>" + spring +
             "</axis2>";
      if (type == "planar") axes += "<axis3>" + spring + "</axis3>";
    } else if (type == "cylindrical") {
      axes = std::string("<axis><xyz>") + x + "</xyz>" + spring + "</axis><axis2>" + spring +
             "</axis2>";
    } else if (type == "ball") {
      axes = "<axis>" + spring + "</axis>";
    } else {
      axes = std::string("<axis><xyz>") + x + "</xyz>" + (driven ? "" : spring) + "</axis>";
    }
    if (type == "screw") axes += element("screw_thread_pitch", number(0.05 * length_));
    joints_ += "<" + tag + " name=\"" + joint + "\" type=\"" + type +
               "\"><parent>base</parent><child>" + name + "</child>" + axes + "</" + tag + ">\n";
    if (driven)
      joints_ += "<cprsim:drive joint=\"" + joint +
                 "\" quantity=\"position\"><smoothstep from=\"0\" to=\"" +
                 number(dice_.within(slides ? 0.05 * length_ : 0.3)) + "\" start=\"0\" end=\"" +
                 number(end_) + "\"/></cprsim:drive>\n";
  }

  void write_leg(int i) {
    if (i == 0)
      plate_pose_ = vector(dice_.within(0.05 * length_), dice_.within(0.05 * length_),
                           length_ * (0.9 + 0.1 * dice_.unit())) +
                    " " + vector(dice_.within(0.2), dice_.within(0.2), dice_.within(0.2));
    const double angle = 2 * std::numbers::pi * i / robot_.rods + dice_.within(0.2);
    const double R = 0.2 * length_;
    const std::string at = vector(R * std::cos(angle), R * std::sin(angle), 0);
    const std::string tilt = " " + vector(dice_.within(0.1), dice_.within(0.1), 0);
    const bool carried = dice_.one_in(3);
    const bool free_tip = robot_.rods == 1 && dice_.one_in(2);
    if (carried) write_carriage(i, at + " 0 0 0");
    // attributes of an end, its pose, its axis
    const auto end = [&](const std::string& of, const std::string& place, bool fixed) {
      const std::string kind =
          fixed ? "fixed" : dice_.of({"fixed", "fixed", "revolute", "universal", "ball"});
      const bool spins = kind != "ball" && dice_.one_in(4);
      return of + " joint=\"" + kind + (spins ? "\" spin=\"free\">" : "\">") +
             element("pose", place) + (kind == "revolute" ? "<axis><xyz>1 0 0</xyz></axis>" : "");
    };
    const std::string below = carried ? "carriage_" + std::to_string(i) : std::string("base");
    rods_ += "<cprsim:rod name=\"leg_" + std::to_string(i) + "\"><base attached_to=" +
             end("\"" + below + "\"", (carried ? "0 0 0" : at) + tilt, robot_.rods == 1) +
             "</base>";
    if (!free_tip)
      rods_ += "<tip attached_to=" + end("\"plate\"", at + tilt, false) + "</tip>";
    else
      has_plate_ = false;
    if (i == 0 || dice_.one_in(4)) {  // legs that differ
      section_ = dice_.of({"circle", "annulus", "rectangle", "ellipse"});
      if (robot_.contact) section_ = "circle";  // others do not touch
      damped_ = damped_ || dice_.one_in(2);
    }
    rods_ += element("length", number(length_ * (0.98 + 0.1 * dice_.unit()))) +
             element("cross_section", section()) +
             element("material", element("density", number(density_)) +
                                     element("youngs_modulus", number(youngs_modulus_)) +
                                     element("poisson_ratio", number(0.1 + 0.39 * dice_.unit())));
    const double EI = youngs_modulus_ * std::numbers::pi / 4 * std::pow(radius_, 4);
    const double tau = dice_.between(1e-6, 1e-2);
    rods_ += element("damping", element("bending", number(tau * EI)) +
                                    element("torsion", number(tau * EI)) +
                                    element("axial", number(tau * EI / (radius_ * radius_))) +
                                    element("shear", number(tau * EI / (radius_ * radius_))));
    if (dice_.one_in(4))
      rods_ +=
          "<rest><curvature>" +
          vector(dice_.within(3 / length_), dice_.within(3 / length_), dice_.within(3 / length_)) +
          "</curvature></rest>";
    rods_ += "</cprsim:rod>\n";
  }

  std::string section() const {
    const std::string r = number(radius_), s = number(0.7 * radius_);
    if (section_ == "circle") return element("circle", element("radius", r));
    if (section_ == "annulus")
      return element("annulus", element("outer_radius", r) + element("inner_radius", s));
    if (section_ == "rectangle")
      return element("rectangle", element("width", r) + element("height", s));
    return element("ellipse", element("semi_axes", r + " " + s));
  }

  std::string obstacles() {
    if (!robot_.contact) return "";
    const std::string shape = dice_.of({"sphere", "box", "plane", "cylinder", "capsule", "cone"});
    const std::string r = number(0.1 * length_);
    std::string size = element("radius", r);
    if (shape == "box") size = element("size", r + " " + r + " " + r);
    if (shape == "plane") size = element("normal", "0 0 1");
    if (shape == "cylinder" || shape == "capsule" || shape == "cone") size += element("length", r);
    const std::string at = shape == "plane"
                               ? vector(0, 0, -0.1 * length_)
                               : vector(0.5 * length_, dice_.within(0.2 * length_), 0.6 * length_);
    return "<model name=\"obstacle\"><static>true</static><link name=\"o\"><pose>" + at +
           " 0 0 0</pose><collision name=\"c\"><geometry>" + element(shape, size) +
           "</geometry></collision></link></model>\n";
  }

  Dice dice_;
  RandomRobot robot_;
  double radius_ = 0, length_ = 0, youngs_modulus_ = 0, density_ = 0, step_ = 0, end_ = 0;
  bool damped_ = false, has_plate_ = true;
  std::string section_, plate_pose_, bodies_, joints_, rods_;
};

}  // namespace

RandomRobot random_robot(std::uint64_t seed) {
  return Writer(seed).write();
}

}  // namespace cprsim
