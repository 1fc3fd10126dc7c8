// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

/// The tags of an XML file, one after another, for files that keep all their data in attributes. One tag is held in
/// memory. Text between tags, comments, processing instructions and CDATA are passed over; nesting is not checked.
/// A document type, and entities but for the five of XML and &#N;, are refused: InputError "FILE:LINE: …".
class XmlTags {
  public:
    explicit XmlTags(const std::string& file);

    /// Advances to the next opening or empty tag; false at the end.
    bool next();
    [[nodiscard]] std::string_view name() const { return name_; }
    /// The attribute's value; nullptr where there is none.
    [[nodiscard]] const std::string* attribute(std::string_view name) const;

    /// The file ended within a tag.
    [[nodiscard]] bool is_cut_off() const { return is_cut_off_; }
    [[nodiscard]] std::string place() const;
    [[nodiscard]] double fraction_read() const;
    [[noreturn]] void fail(std::string_view message) const;

  private:
    struct Attribute {
        std::string name;
        std::string value;
    };
    bool skip_to_tag();
    bool read_tag_text();
    bool skip_until(std::string_view end);
    void parse_tag();
    void take_attribute(std::string_view name, std::string_view value);
    [[nodiscard]] std::string decoded(std::string_view text) const;
    [[nodiscard]] char entity(std::string_view name) const;
    int take();

    std::string file_;
    std::ifstream in_;
    std::string tag_;  ///< between < and >
    std::string name_;
    std::vector<Attribute> attributes_;
    std::size_t attribute_count_ = 0;
    std::size_t line_ = 1;
    std::size_t tag_line_ = 1;
    bool is_cut_off_ = false;
    std::uintmax_t bytes_read_ = 0;
    std::uintmax_t bytes_ = 0;
};

}  // namespace millforce::host
