// SPDX-License-Identifier: Apache-2.0
#include "import/xml_tags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <utility>

#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/text_lines.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

constexpr std::size_t longest_tag = std::size_t{1} << 16U;
constexpr int end_of_xml = std::char_traits<char>::eof();
constexpr std::string_view xml_spaces = " \t\r\n";

/// Takes the beginning of `text` up to one of `ends`.
std::string_view take_word(std::string_view& text, std::string_view ends) {
    const std::size_t length = std::min(text.find_first_of(ends), text.size());
    const std::string_view word = text.substr(0, length);
    text.remove_prefix(length);
    return word;
}

void skip_xml_spaces(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(xml_spaces), text.size()));
}

}  // namespace

XmlTags::XmlTags(const std::string& file) : file_(file), in_(open_to_read(file)) {
    std::error_code error;
    bytes_ = std::filesystem::file_size(file, error);
    bytes_ = error ? 0 : bytes_;
}

int XmlTags::take() {
    const int letter = in_.rdbuf()->sbumpc();
    bytes_read_ += letter != end_of_xml ? 1U : 0U;
    line_ += letter == '\n' ? 1U : 0U;
    if (letter == 0) {
        tag_line_ = line_;
        fail("a NUL byte; expected XML in UTF-8");
    }
    return letter;
}

bool XmlTags::skip_to_tag() {
    int letter = take();
    while (letter != '<' && letter != end_of_xml) {
        letter = take();
    }
    tag_line_ = line_;
    return letter == '<';
}

bool XmlTags::skip_until(std::string_view end) {
    std::string last;
    for (int letter = take(); letter != end_of_xml; letter = take()) {
        last += static_cast<char>(letter);
        if (last.ends_with(end)) {
            return true;
        }
        if (last.size() >= 2 * end.size()) {
            last.erase(0, last.size() - end.size());
        }
    }
    is_cut_off_ = true;
    return false;
}

/// Up to the > that ends the tag; one in an attribute does not. False at the end of the file.
bool XmlTags::read_tag_text() {
    tag_.clear();
    char quote = '\0';
    for (int letter = take(); letter != end_of_xml; letter = take()) {
        const char c = static_cast<char>(letter);
        if (c == '>' && quote == '\0') {
            return true;
        }
        if (c == quote) {
            quote = '\0';
        } else if (quote == '\0' && (c == '"' || c == '\'')) {
            quote = c;
        }
        tag_ += c;
        if (tag_ == "!--") {
            return skip_until("-->");
        }
        if (tag_ == "![CDATA[") {
            return skip_until("]]>");
        }
        if (tag_.size() > longest_tag) {
            fail("a tag of more than 64 KiB; expected XML");
        }
    }
    is_cut_off_ = true;
    return false;
}

bool XmlTags::next() {
    while (skip_to_tag()) {
        if (!read_tag_text()) {
            return false;
        }
        if (tag_.starts_with("!DOCTYPE")) {
            fail("a document type; expected none");
        }
        const bool is_element = !tag_.empty() && tag_[0] != '/' && tag_[0] != '!' && tag_[0] != '?';
        if (is_element) {
            parse_tag();
            return true;
        }
    }
    return false;
}

void XmlTags::parse_tag() {
    std::string_view rest = tag_;
    if (rest.ends_with('/')) {
        rest.remove_suffix(1);
    }
    name_ = take_word(rest, xml_spaces);
    attribute_count_ = 0;
    for (skip_xml_spaces(rest); !rest.empty(); skip_xml_spaces(rest)) {
        const std::string_view name = take_word(rest, " \t\r\n=");
        skip_xml_spaces(rest);
        if (name.empty() || !rest.starts_with('=')) {
            fail(fmt::format("'{}' in the tag <{}>, expected attributes like time=\"0.002\"", printable(name),
                             printable(name_)));
        }
        rest.remove_prefix(1);
        skip_xml_spaces(rest);
        const std::string_view quote = rest.substr(0, 1);
        if (quote != "\"" && quote != "'") {
            fail(fmt::format("attribute {} of the tag <{}>: expected a value in quotes", printable(name),
                             printable(name_)));
        }
        rest.remove_prefix(1);
        const std::string_view value = take_word(rest, quote);
        if (rest.empty()) {
            fail(fmt::format("attribute {}: a quote is not closed", printable(name)));
        }
        rest.remove_prefix(1);
        take_attribute(name, value);
    }
}

void XmlTags::take_attribute(std::string_view name, std::string_view value) {
    if (attribute_count_ == attributes_.size()) {
        attributes_.emplace_back();
    }
    Attribute& attribute = attributes_[attribute_count_++];
    attribute.name = name;
    if (value.find('&') == std::string_view::npos) {
        attribute.value = value;
    } else {
        attribute.value = decoded(value);
    }
}

char XmlTags::entity(std::string_view name) const {
    constexpr std::array<std::pair<std::string_view, char>, 5> known{
        {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};
    for (const auto& [word, letter] : known) {
        if (name == word) {
            return letter;
        }
    }
    unsigned code = 0;
    const bool is_hex = name.starts_with("#x");
    const std::string_view digits = name.substr(std::min<std::size_t>(name.size(), is_hex ? 2 : 1));
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, is_hex ? 16 : 10);
    if (!name.starts_with('#') || error != std::errc{} || end != digits.data() + digits.size()) {
        fail(fmt::format("&{}; is not known; expected &amp; &lt; &gt; &quot; &apos; or &#N;", printable(name)));
    }
    return code > 0 && code < 0x80 ? static_cast<char>(code) : '?';
}

std::string XmlTags::decoded(std::string_view text) const {
    std::string result;
    while (!text.empty()) {
        result += take_word(text, "&");
        if (text.empty()) {
            break;
        }
        text.remove_prefix(1);
        const std::string_view name = take_word(text, ";");
        if (text.empty()) {
            fail("'&' without ';' in an attribute");
        }
        text.remove_prefix(1);
        result += entity(name);
    }
    return result;
}

const std::string* XmlTags::attribute(std::string_view name) const {
    for (std::size_t k = 0; k < attribute_count_; ++k) {
        if (attributes_[k].name == name) {
            return &attributes_[k].value;
        }
    }
    return nullptr;
}

std::string XmlTags::place() const {
    return fmt::format("{}:{}", file_, tag_line_);
}

double XmlTags::fraction_read() const {
    return bytes_ > 0 ? std::min(1.0, static_cast<double>(bytes_read_) / static_cast<double>(bytes_)) : 0.0;
}

void XmlTags::fail(std::string_view message) const {
    throw InputError(fmt::format("{}: {}", place(), message));
}

}  // namespace millforce::host
