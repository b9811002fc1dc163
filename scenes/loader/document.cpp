// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/document.h"

#include <tinyxml2.h>

#include <algorithm>
#include <map>
#include <optional>

#include "scenes/loader/reporter.h"
#include "scenes/loader/scan.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr std::string_view kNamespace = "urn:cprsim:1";
using Prefixes = std::map<std::string, std::string, std::less<>>;

// Walks the parsed elements in document order beside the scanned tags, which have the columns.
class Builder {
 public:
  Builder(std::vector<ScannedTag> tags, int file, Reporter& report)
      : tags_(std::move(tags)), file_(file), report_(report) {}

  std::unique_ptr<Node> build(const tinyxml2::XMLElement& element, Prefixes prefixes) {
    auto node = std::make_unique<Node>();
    const std::string_view written = element.Name();
    const ScannedTag* tag = next_ < tags_.size() ? &tags_[next_++] : nullptr;
    if (tag && tag->name != written) tag = nullptr;
    node->place = tag ? tag->place : Place{file_, element.GetLineNum(), 1};
    if (tag) node->text_place = tag->text;
    node->name = written;
    read_attributes(element, tag, *node, prefixes);
    node->name = canonical(written, *node, prefixes);
    for (auto* child = element.FirstChild(); child; child = child->NextSibling()) {
      if (const auto* text = child->ToText()) node->text += text->Value();
      if (const auto* inner = child->ToElement()) node->append(build(*inner, prefixes));
    }
    node->text = trim(node->text);
    return node;
  }

 private:
  void read_attributes(const tinyxml2::XMLElement& element, const ScannedTag* tag, Node& node,
                       Prefixes& prefixes) {
    std::size_t k = 0;
    for (auto* a = element.FirstAttribute(); a; a = a->Next(), ++k) {
      Attribute attribute{a->Name(), a->Value(), node.place, Place{}};
      if (tag && k < tag->attributes.size()) {
        attribute.place = tag->attributes[k].name;
        attribute.value_place = tag->attributes[k].value;
      }
      if (attribute.name.substr(0, 6) == "xmlns:") {
        prefixes[attribute.name.substr(6)] = attribute.value;
        check_schema(attribute, node);
      }
      node.attributes.push_back(std::move(attribute));
    }
  }

  void check_schema(const Attribute& attribute, const Node& node) {
    const bool ours = attribute.value.substr(0, 11) == "urn:cprsim:";
    if ((ours || attribute.name == "xmlns:cprsim") && attribute.value != kNamespace)
      report_.bad_value("E204", node, attribute,
                        "'" + attribute.value + "' is no schema this version knows",
                        "did you mean urn:cprsim:1?");
  }

  std::string canonical(std::string_view written, Node& node, const Prefixes& prefixes) {
    const std::size_t colon = written.find(':');
    if (colon == std::string_view::npos) return std::string(written);
    const std::string_view prefix = written.substr(0, colon);
    const auto found = prefixes.find(prefix);
    if (found == prefixes.end() && prefix == "cprsim") {
      if (!undeclared_)
        report_.error("E204", node, "the prefix of <" + std::string(written) + "> is not declared",
                      "write <sdf version=\"1.11\" xmlns:cprsim=\"urn:cprsim:1\">");
      undeclared_ = true;
      return std::string(written);
    }
    if (prefix == "cprsim" || (found != prefixes.end() && found->second == kNamespace))
      return "cprsim:" + std::string(written.substr(colon + 1));
    node.foreign = true;
    return std::string(written);
  }

  std::vector<ScannedTag> tags_;
  std::size_t next_ = 0;
  int file_;
  Reporter& report_;
  bool undeclared_ = false;
};

std::string explain(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed, or closed by another's end tag";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is malformed or given twice";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment is not closed";
    case tinyxml2::XML_ERROR_PARSING_CDATA:
      return "a CDATA section is not closed";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "text ends without an end tag";
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "there is no element";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "the <?xml ...?> declaration is malformed or not first";
    default:
      return "this is not well-formed XML";
  }
}

bool acceptable_bytes(const std::string& text, int file, Reporter& report) {
  const std::string_view start = std::string_view(text).substr(0, 2);
  if (start == "\xFF\xFE" || start == "\xFE\xFF") {
    report.at(Severity::kError, "E202", {file, 1, 1}, 0, "UTF-16 is not supported; use UTF-8");
    return false;
  }
  const std::size_t bad = find_bad_byte(text);
  if (bad == std::string_view::npos) return true;
  const auto& lines = report.files()[static_cast<std::size_t>(file)].line_starts;
  const auto after = std::upper_bound(lines.begin(), lines.end(), bad);
  report.at(
      Severity::kError, "E202",
      {file, static_cast<int>(after - lines.begin()), static_cast<int>(bad - *(after - 1)) + 1}, 0,
      "a byte that is not valid UTF-8 text");
  return false;
}

}  // namespace

std::unique_ptr<Node> parse_document(const std::string& text, int file, Reporter& report) {
  if (trim(text).empty()) {
    report.at(Severity::kError, "E104", {file, 0, 0}, 0, "the file is empty");
    return nullptr;
  }
  if (!acceptable_bytes(text, file, report)) return nullptr;
  const std::size_t errors = report.all().size();
  std::vector<ScannedTag> tags = scan_tags(text, file, report);
  if (report.all().size() > errors) return nullptr;

  tinyxml2::XMLDocument document(true, tinyxml2::PRESERVE_WHITESPACE);
  const tinyxml2::XMLError error = document.Parse(text.data(), text.size());
  if (error != tinyxml2::XML_SUCCESS) {
    report.at(Severity::kError, "E201", {file, document.ErrorLineNum(), 1}, 0, explain(error));
    return nullptr;
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (!root) {
    report.at(Severity::kError, "E201", {file, 1, 1}, 0, "there is no element");
    return nullptr;
  }
  for (auto* node = document.FirstChild(); node; node = node->NextSibling())
    if (node->ToText() && !trim(node->Value()).empty()) {
      report.at(Severity::kError, "E201", {file, node->GetLineNum(), 1}, 0,
                "text outside the root element");
      return nullptr;
    }
  return Builder(std::move(tags), file, report).build(*root, {});
}

}  // namespace cprsim
