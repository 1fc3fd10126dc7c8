// SPDX-License-Identifier: Apache-2.0
#include "cnc/gcode_block.hpp"

#include <fmt/format.h>

#include <cmath>

namespace millforce::sim::gcode {

namespace {

constexpr std::string_view known_g_codes = "a code of the table in sim/cnc/README.md";

class Sorter {
  public:
    Sorter(std::string_view file_name, std::size_t line) : file_name_(file_name), line_(line) {}

    SortedBlock sort(const GcodeBlock& block) const {
        SortedBlock sorted;
        for (const GcodeWord& word : block.words) {
            const bool is_code = word.letter == 'G' || word.letter == 'M';
            if (!is_code && std::string_view("FHIJKLNPQRSTXYZ").find(word.letter) == std::string_view::npos) {
                fail(word, "one of the words F G H I J K L M N P Q R S T X Y Z");
            }
            const GcodeWord*& slot = word.letter == 'G' ? sorted.codes[group_of_g(word)]
                                     : word.letter == 'M'
                                         ? sorted.codes[group_of_m(word)]
                                         : sorted.addresses[static_cast<std::size_t>(word.letter - 'A')];
            if (slot != nullptr && !(word.letter == 'M' && group_of_m(word) == coolant)) {
                fail(word, fmt::format("no second word of the group of '{}' in one block", slot->text));
            }
            slot = &word;
        }
        check_block_number(block, sorted);
        return sorted;
    }

  private:
    [[noreturn]] void fail(const GcodeWord& word, std::string_view expected) const {
        reject({file_name_, line_, word.column}, word.text, expected);
    }

    ModalGroup group_of_g(const GcodeWord& word) const {
        const double tenfold = word.value * 10.0;
        if (!(tenfold >= 0.0 && tenfold <= 9999.0) || std::abs(tenfold - std::round(tenfold)) > 1e-6) {
            fail(word, known_g_codes);
        }
        switch (tenths(word)) {
            case 0:
            case 10:
            case 20:
            case 30:
            case 730:
            case 810:
            case 820:
            case 830:
                return motion;
            case 40:
                return dwell;
            case 170:
            case 180:
            case 190:
                return plane;
            case 200:
            case 210:
                return units;
            case 900:
            case 910:
                return distance;
            case 400:
                return cutter_compensation;
            case 430:
            case 490:
                return tool_length;
            case 540:
            case 550:
            case 560:
            case 570:
            case 580:
            case 590:
                return coordinate_system;
            case 280:
            case 300:
            case 530:
                return retreat;
            case 911:
                return arc_centre;
            case 980:
            case 990:
                return return_level;
            case 410:
            case 420:
                fail(word, "G40: let the CAM system compensate the cutter's radius");
            case 901:
                fail(word, "G91.1: arc centres relative to the start");
            case 920:
                fail(word, "no shift of coordinates: let the CAM system post them");
            case 930:
            case 950:
                fail(word, "G94: a feed in mm or inches per minute");
            case 610:
            case 640:
                return path_mode;
            case 800:
                return canned_cycle;
            case 940:
                return feed_mode;
            default:
                fail(word, known_g_codes);
        }
    }

    ModalGroup group_of_m(const GcodeWord& word) const {
        if (word.value == 3.0 || word.value == 5.0) {
            return spindle;
        }
        if (word.value == 2.0 || word.value == 30.0) {
            return stopping;
        }
        if (word.value == 52.0) {
            return adaptive_feed;
        }
        if (word.value == 4.0) {
            fail(word, "M3: the cutter is right-handed and cuts clockwise only");
        }
        if (word.value == 0.0 || word.value == 1.0) {
            return pause;
        }
        if (word.value == 6.0) {
            return tool_change;
        }
        if (word.value == 7.0 || word.value == 8.0 || word.value == 9.0) {
            return coolant;
        }
        if (word.value == 98.0 || word.value == 99.0) {
            fail(word, "a program without subprograms: let the CAM system post it whole");
        }
        fail(word, "one of M0 M1 M2 M3 M5 M6 M7 M8 M9 M30 M52");
    }

    void check_block_number(const GcodeBlock& block, const SortedBlock& sorted) const {
        const GcodeWord* number = sorted.address('N');
        if (number == nullptr) {
            return;
        }
        if (number != &block.words.front()) {
            fail(*number, "the block number at the begin of the block");
        }
        if (!(number->value >= 0.0 && number->value <= 999'999'999.0) || number->value != std::floor(number->value)) {
            fail(*number, "a block number from 0 to 999999999");
        }
    }

    std::string_view file_name_;
    std::size_t line_;
};

}  // namespace

long tenths(const GcodeWord& word) {
    return std::lround(word.value * 10.0);
}

SortedBlock sort_words(const GcodeBlock& block, std::string_view file_name) {
    return Sorter(file_name, block.line).sort(block);
}

}  // namespace millforce::sim::gcode
