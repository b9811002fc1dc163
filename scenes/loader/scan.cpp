// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/scan.h"

#include <algorithm>

#include "scenes/loader/reporter.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostAttributes = 256;
constexpr std::size_t kMostElements = 100'000;
constexpr int kDeepest = 90;

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

class Scanner {
 public:
  Scanner(const std::string& text, int file, Reporter& report)
      : text_(text),
        lines_(report.files()[static_cast<std::size_t>(file)].line_starts),
        file_(file),
        report_(report) {}

  std::vector<ScannedTag> run() {
    while (good_ && at_ < text_.size()) {
      const std::size_t open = text_.find('<', at_);
      if (open == std::string::npos) break;
      at_ = open;
      one_markup();
    }
    if (!good_) tags_.clear();
    return std::move(tags_);
  }

 private:
  bool starts(std::string_view with) const {
    return std::string_view(text_).substr(at_, with.size()) == with;
  }

  void skip_past(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string::npos ? text_.size() : found + end.size();
  }

  // XML forbids "--" within a comment: two comments, one of them not closed, would hide what lies
  // between them
  void comment() {
    const std::size_t open = at_;
    const std::size_t dashes = text_.find("--", at_ + 4);
    at_ = dashes == std::string::npos ? open : dashes;
    if (dashes == std::string::npos) return refuse("E201", "this comment has no end");
    if (!starts("-->")) return refuse("E201", "'--' within a comment; was the one before closed?");
    at_ += 3;
  }

  void one_markup() {
    if (starts("<!--")) {
      comment();
    } else if (starts("<![CDATA[")) {
      skip_past("]]>");
    } else if (starts("<!")) {
      refuse("E203", "document type and entity declarations are not allowed in a scene");
    } else if (starts("<?")) {
      skip_past("?>");
    } else if (starts("</")) {
      --depth_;
      skip_past(">");
    } else {
      start_tag();
    }
  }

  void start_tag() {
    if (depth_ == 0 && !tags_.empty())
      return refuse("E206", "a second root element; a scene has exactly one, <sdf>");
    if (depth_ >= kDeepest) return refuse("E105", "elements are nested more than 90 deep");
    if (tags_.size() >= kMostElements) return refuse("E105", "more than 100000 elements");
    ScannedTag tag;
    tag.place = place(at_);
    const std::size_t name = ++at_;
    while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != '>' && text_[at_] != '/')
      ++at_;
    tag.name = std::string_view(text_).substr(name, at_ - name);
    attributes(tag);
    if (!good_) return;
    const bool closed = at_ > 0 && at_ < text_.size() && text_[at_ - 1] == '/';
    if (at_ < text_.size()) ++at_;
    if (!closed) ++depth_;
    std::size_t content = at_;
    while (content < text_.size() && is_space(text_[content]))
      ++content;
    if (!closed && content < text_.size() && text_[content] != '<') tag.text = place(content);
    tags_.push_back(std::move(tag));
  }

  // leaves at_ on the closing '>'
  void attributes(ScannedTag& tag) {
    while (at_ < text_.size() && text_[at_] != '>') {
      if (is_space(text_[at_]) || text_[at_] == '/') {
        ++at_;
        continue;
      }
      if (tag.attributes.size() >= kMostAttributes)
        return refuse("E105", "more than 256 attributes in one element");
      ScannedAttribute attribute;
      attribute.name = place(at_);
      while (at_ < text_.size() && text_[at_] != '=' && text_[at_] != '>')
        ++at_;
      while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\'' && text_[at_] != '>')
        ++at_;
      if (at_ >= text_.size() || text_[at_] == '>') return;
      const char quote = text_[at_++];
      attribute.value = place(at_);
      const std::size_t end = text_.find(quote, at_);
      at_ = end == std::string::npos ? text_.size() : end + 1;
      tag.attributes.push_back(attribute);
    }
  }

  Place place(std::size_t offset) const {
    const auto after = std::upper_bound(lines_.begin(), lines_.end(), offset);
    Place result;
    result.file = file_;
    result.line = static_cast<int>(after - lines_.begin());
    result.column = static_cast<int>(offset - *(after - 1)) + 1;
    return result;
  }

  void refuse(std::string_view code, std::string message) {
    report_.at(Severity::kError, code, place(at_), 1, std::move(message));
    good_ = false;
  }

  const std::string& text_;
  const std::vector<std::size_t>& lines_;
  int file_;
  Reporter& report_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool good_ = true;
  std::vector<ScannedTag> tags_;
};

// bytes of the UTF-8 sequence at the start of `text`, 0 if it is none
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
  };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool overlong = first == 0xE0 && byte(1) < 0xA0;
    const bool surrogate = first == 0xED && byte(1) >= 0xA0;
    return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool overlong = first == 0xF0 && byte(1) < 0x90;
    const bool beyond = first == 0xF4 && byte(1) >= 0x90;
    return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
  }
  return 0;
}

}  // namespace

std::vector<ScannedTag> scan_tags(const std::string& text, int file, Reporter& report) {
  return Scanner(text, file, report).run();
}

std::size_t find_bad_byte(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t length = sequence_length(text.substr(i, 4));
    if (length == 0) return i;
    i += length;
  }
  return std::string_view::npos;
}

}  // namespace cprsim
