// SPDX-License-Identifier: BSD-3-Clause
// The one table of codes. Codes never change meaning; a retired code is not used again.
#include "scenes/loader/diagnostic.h"

namespace cprsim {

const std::vector<CodeEntry>& diagnostic_codes() {
  static const std::vector<CodeEntry> kCodes{
      {"E101", "the file cannot be opened or read"},
      {"E102", "the path is not a regular file (a directory, pipe or device)"},
      {"E103", "the file is larger than 16 MiB"},
      {"E104", "the file is empty"},
      {"E105", "a limit on nesting, attributes or elements is exceeded"},
      {"E106", "an included file or mesh was not found; every place tried is listed"},
      {"E107", "a file lies outside the scene's folder and the resource paths, or on the network"},
      {"E108", "includes form a loop or are nested deeper than 8"},
      {"E109", "a mesh cannot be used"},
      {"E110", "a table of numbers in a file cannot be used"},
      {"E201", "the file is not well-formed XML"},
      {"E202", "the file is not valid UTF-8, or holds control characters"},
      {"E203", "a document type or entity declaration; scenes may not have one"},
      {"E204", "a namespace prefix is not declared, or the cprsim prefix names another schema"},
      {"E205", "the root element is not <sdf>: this is not a scene file"},
      {"E206", "more than one root element"},
      {"E207", "the SDF version is missing, too old or unknown"},
      {"E301", "an element that does not exist at this place"},
      {"E302", "an attribute that does not exist at this place"},
      {"E303", "a required element is missing"},
      {"E304", "an element is given more often than allowed"},
      {"E305", "a value is not of its type (a finite number, a vector, true or false, a name)"},
      {"E306", "a value is outside its range"},
      {"E307", "a value is none of the possible words"},
      {"E308", "a required attribute is missing"},
      {"E309", "text where only elements belong"},
      {"E310", "elements or attributes that exclude or require each other"},
      {"E311", "an override's path names nothing, or several things, or nothing that has a value"},
      {"E401", "a name is used twice in one scope"},
      {"E402", "a reserved or malformed name"},
      {"E403", "a link, frame, joint or model that does not exist"},
      {"E404", "a rod, rod point or tendon that does not exist"},
      {"E405", "frames, attachments or classes refer to each other in a loop"},
      {"E406", "a model that is not static has no link"},
      {"E407", "a joint connects a body with itself, or has the world as its child"},
      {"E408", "a rod class that does not exist"},
      {"E409", "a profile that does not exist"},
      {"E410", "a camera that does not exist"},
      {"E411", "a channel that does not exist"},
      {"E412", "two drives act on the same quantity"},
      {"E501",
       "a movable link has no mass or inertia (SDF's silent default would be 1 kg, 1 kg m2)"},
      {"E502", "an inertia that no body can have"},
      {"E503", "an effect is listed and the data it needs is missing"},
      {"E504", "a world with rods has no <cprsim:effects>; effects are never chosen silently"},
      {"E505", "a rod's cross-section, material or stiffness is incomplete"},
      {"E506", "a physically impossible shape, attitude or direction"},
      {"E507", "the simulation's mode or duration is missing or contradictory"},
      {"E508",
       "a drive leaves its joint's limits or makes a rod's length or a tendon's tension negative"},
      {"E509", "a size that would need unreasonable memory or time"},
      {"E510", "a rod cannot reach between two places that do not move"},
      {"E511", "a planar scene in which something leaves the plane"},
      {"E520", "part of the scene language, but not available in this version"},
      {"W501", "an implausible material or section: check the units (SI only)"},
      {"W502", "a rod too thick for rod theory (slenderness below 5)"},
      {"W503", "an effect has nothing to act on"},
      {"W504", "a time step that does not fit the duration"},
      {"W505", "joint limits that nothing enforces in this version"},
      {"W506", "rods pass through bodies in free flight that may touch other bodies, too"},
      {"W507", "a quaternion or direction was not of unit length and has been normalised"},
      {"W508", "a resolution that belongs to a method no rod uses"},
      {"W511", "data for an effect that is not listed"},
      {"W590", "elements that have no effect in a headless simulation"},
      {"W591", "elements of other namespaces, skipped"},
      {"W592", "parts that this version reads but does not carry out during a run"},
  };
  return kCodes;
}

std::string_view explain_code(std::string_view code) {
  for (const CodeEntry& entry : diagnostic_codes())
    if (code == entry.code) return entry.explanation;
  return {};
}

}  // namespace cprsim
