// SPDX-License-Identifier: Apache-2.0
#include "cnc/gcode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <istream>
#include <numbers>
#include <optional>

#include "cnc/drilling_cycle.hpp"
#include "cnc/gcode_words.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr double arc_tolerance_mm = 0.005;
constexpr double coincident_mm = 1e-7;
constexpr double largest_feed_mm_min = 1e6;
constexpr double largest_spindle_speed_rpm = 1e6;
constexpr double longest_dwell_s = 3600.0;
constexpr std::size_t largest_text_bytes = std::size_t{256} << 20U;

constexpr std::string_view known_g_codes = "a code of the table in sim/cnc/README.md";

/// Codes of one group exclude each other within a block.
enum ModalGroup : std::size_t {
    motion,
    dwell,
    plane,
    units,
    distance,
    cutter_compensation,
    tool_length,
    coordinate_system,
    canned_cycle,
    return_level,
    arc_centre,
    retreat,
    feed_mode,
    spindle,
    stopping,
    path_mode,
    adaptive_feed,
    tool_change,
    coolant,
    pause,
    group_count,
};

/// The words of a block, sorted by what they are; each points into the block.
struct SortedBlock {
    std::array<const GcodeWord*, group_count> codes{};
    std::array<const GcodeWord*, 26> addresses{};

    const GcodeWord* code(ModalGroup group) const { return codes[group]; }
    const GcodeWord* address(char letter) const { return addresses[static_cast<std::size_t>(letter - 'A')]; }
    const GcodeWord* first_of(std::string_view letters) const {
        const GcodeWord* first = nullptr;
        for (const char letter : letters) {
            const GcodeWord* word = address(letter);
            if (word != nullptr && (first == nullptr || word->column < first->column)) {
                first = word;
            }
        }
        return first;
    }
};

/// A G code in tenths: 17 is 170. Codes carry at most one decimal, and rounding keeps G20 and G20.0 the same.
long tenths(const GcodeWord& word) {
    return std::lround(word.value * 10.0);
}

class Interpreter {
  public:
    Interpreter(std::string_view file_name, const GcodeSettings& settings)
        : file_name_(file_name),
          max_moves_(settings.max_moves),
          position_mm_(settings.start_mm),
          start_height_mm_(settings.start_mm.z()) {}

    void run(const GcodeBlock& block) {
        line_ = block.line;
        if (block.is_percent) {
            ended_ = percent_seen_ || block_seen_;
            percent_seen_ = true;
            return;
        }
        if (block.words.empty()) {
            return;
        }
        block_seen_ = true;
        if (is_program_number(block)) {
            return;
        }
        const SortedBlock sorted = sort(block);
        set_modes(sorted);
        follow_tool(sorted);
        run_dwell(sorted);
        if (sorted.code(retreat) != nullptr) {
            run_retreat(sorted);
        } else if (cycle_.has_value()) {
            run_cycle(sorted);
        } else {
            run_motion(sorted);
        }
        ended_ = sorted.code(stopping) != nullptr;
    }

    bool ended() const { return ended_; }
    /// A file that began with % and is cut off before the closing one is no program.
    bool may_end_here() const { return block_seen_ && !percent_seen_; }
    void note_end() { note("the program ends with its file: no M2 or M30"); }
    std::vector<Move> take_moves() { return std::move(moves_); }
    std::vector<std::string> take_notes() { return std::move(notes_); }

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

    SortedBlock sort(const GcodeBlock& block) const {
        SortedBlock sorted;
        for (const GcodeWord& word : block.words) {
            const bool is_code = word.letter == 'G' || word.letter == 'M';
            if (!is_code && std::string_view("FHIJLNPQRSTXYZ").find(word.letter) == std::string_view::npos) {
                fail(word, "one of the words F G H I J L M N P Q R S T X Y Z");
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

    void set_modes(const SortedBlock& block) {
        if (const GcodeWord* word = block.code(units)) {
            mm_per_unit_ = tenths(*word) == 200 ? mm_per_inch : 1.0;
        }
        if (const GcodeWord* word = block.code(distance)) {
            relative_ = tenths(*word) == 910;
        }
        if (const GcodeWord* word = block.address('F')) {
            const double feed_mm_min = word->value * mm_per_unit_;
            if (!(feed_mm_min > 0.0 && feed_mm_min <= largest_feed_mm_min)) {
                fail(*word, "a feed above 0 and at most 1000000 mm/min");
            }
            feed_mm_s_ = feed_mm_min / 60.0;
        }
        if (const GcodeWord* word = block.address('S')) {
            if (!(word->value >= 0.0 && word->value <= largest_spindle_speed_rpm)) {
                fail(*word, "a spindle speed from 0 to 1000000 rev/min");
            }
            spindle_speed_rad_s_ = word->value * 2.0 * std::numbers::pi / 60.0;
        }
        if (const GcodeWord* word = block.code(spindle)) {
            spindle_on_ = word->value == 3.0;
        }
        if (const GcodeWord* word = block.code(return_level)) {
            returns_to_retract_ = tenths(*word) == 990;
        }
        if (const GcodeWord* word = block.code(plane)) {
            is_xy_plane_ = tenths(*word) == 170;
        }
        if (const GcodeWord* word = block.code(coordinate_system)) {
            choose_coordinates(*word);
        }
        if (block.code(coolant) != nullptr) {
            note("M7, M8, M9: coolant is not simulated");
        }
        if (block.code(pause) != nullptr) {
            note("M0, M1: the program goes on at once");
        }
        if (const GcodeWord* word = block.code(tool_length); word != nullptr && tenths(*word) == 430) {
            note("G43: coordinates are those of the tool's tip");
        }
        if (block.code(canned_cycle) != nullptr && cycle_.has_value()) {
            cycle_.reset();
            motion_.reset();
        }
        if (const GcodeWord* word = block.code(motion)) {
            set_motion(tenths(*word) / 10);
        }
    }

    /// O1001 alone: the number of a program.
    bool is_program_number(const GcodeBlock& block) const {
        const GcodeWord& first = block.words.front();
        if (first.letter != 'O') {
            return false;
        }
        if (block.words.size() > 1) {
            fail(first, "a program without O-words: let the CAM system post it whole");
        }
        return true;
    }

    void set_motion(long code) {
        constexpr std::array kinds{MoveKind::rapid, MoveKind::feed_line, MoveKind::arc_cw, MoveKind::arc_ccw};
        const bool is_line_or_arc = code < static_cast<long>(kinds.size());
        motion_ = is_line_or_arc ? std::optional(kinds[static_cast<std::size_t>(code)]) : std::nullopt;
        if (is_line_or_arc) {
            cycle_.reset();
            return;
        }
        if (!cycle_.has_value()) {
            height_before_cycle_mm_ = position_mm_.z();
            cycle_.emplace();
            has_bottom_ = false;
            has_retract_ = false;
        }
        cycle_->code = static_cast<int>(code);
    }

    /// One of G54 to G59, whichever the program uses: another one would lie elsewhere on the machine.
    void choose_coordinates(const GcodeWord& word) {
        if (coordinates_ != 0 && coordinates_ != tenths(word)) {
            fail(word, fmt::format("G{}: one system of coordinates in a program", coordinates_ / 10));
        }
        coordinates_ = tenths(word);
    }

    void follow_tool(const SortedBlock& block) {
        if (const GcodeWord* word = block.address('T')) {
            if (!(word->value >= 0.0) || word->value != std::floor(word->value)) {
                fail(*word, "a tool number");
            }
            selected_tool_ = word->value;
        }
        const GcodeWord* change = block.code(tool_change);
        if (change == nullptr) {
            return;
        }
        if (has_cut_ && selected_tool_ != tool_) {
            fail(*change,
                 fmt::format("no other tool than T{}: a scenario has one; split the program at the change", tool_));
        }
        tool_ = selected_tool_;
        note("M6: the tool is the scenario's");
    }

    /// The machine's own positions are not known here: what matters is that the tool leaves the part.
    void run_retreat(const SortedBlock& block) {
        const GcodeWord& code = *block.code(retreat);
        note(
            "G28, G30, G53: a rapid straight up to the height of the start; the machine's own positions are not known");
        if (const GcodeWord* word = block.first_of("IJR")) {
            fail(*word, "no arc with G28, G30 or G53");
        }
        if (motion_.has_value() && *motion_ != MoveKind::rapid && tenths(code) == 530) {
            fail(code, "G53 with G0 only");
        }
        if (position_mm_.z() < start_height_mm_) {
            Move move = next_move(MoveKind::rapid, {position_mm_.x(), position_mm_.y(), start_height_mm_});
            position_mm_ = move.end_mm;
            append(move, code);
        }
    }

    /// One hole at the block's X and Y. Z, R, Q and P stay until G80.
    void run_cycle(const SortedBlock& block) {
        const GcodeWord* word = block.first_of("XYZR");
        if (const GcodeWord* stray = block.first_of("IJ")) {
            fail(*stray, "I, J with an arc (G2, G3) only");
        }
        if (const GcodeWord* repeats = block.address('L'); repeats != nullptr && repeats->value != 1.0) {
            fail(*repeats, "L1: one hole for each block");
        }
        if (word == nullptr) {
            return;
        }
        take_cycle_levels(block);
        if (!has_bottom_ || !has_retract_) {
            fail(*word, "Z and R with the first hole of a cycle");
        }
        if (!(cycle_->bottom_mm < cycle_->retract_mm)) {
            fail(*word, "R above Z");
        }
        if ((cycle_->code == 83 || cycle_->code == 73) && !(cycle_->peck_mm > 0.0)) {
            fail(*word, "a peck Q above 0 with G73 and G83");
        }
        require_cutting_conditions(*word);
        drill(block, *word);
    }

    void take_cycle_levels(const SortedBlock& block) {
        const double from_mm = relative_ ? position_mm_.z() : 0.0;
        if (const GcodeWord* word = block.address('R')) {
            cycle_->retract_mm = from_mm + offset_mm(word);
            has_retract_ = true;
        }
        if (const GcodeWord* word = block.address('Z')) {
            cycle_->bottom_mm = (relative_ ? cycle_->retract_mm : 0.0) + offset_mm(word);
            has_bottom_ = true;
        }
        if (const GcodeWord* word = block.address('Q')) {
            cycle_->peck_mm = offset_mm(word);
        }
        if (const GcodeWord* word = block.address('P'); word != nullptr && block.code(dwell) == nullptr) {
            if (!(word->value >= 0.0 && word->value <= longest_dwell_s)) {
                fail(*word, "a dwell from 0 to 3600 s");
            }
            cycle_->dwell_s = word->value;
        }
        cycle_->clear_mm =
            returns_to_retract_ ? cycle_->retract_mm : std::max(cycle_->retract_mm, height_before_cycle_mm_);
    }

    void drill(const SortedBlock& block, const GcodeWord& subject) {
        Eigen::Vector3d above = target(block);
        above.z() = std::max(position_mm_.z(), cycle_->retract_mm);
        go(MoveKind::rapid, {position_mm_.x(), position_mm_.y(), above.z()}, subject);
        go(MoveKind::rapid, above, subject);
        go(MoveKind::rapid, {above.x(), above.y(), cycle_->retract_mm}, subject);
        for (const DrillingCycle::Step& step : cycle_->steps()) {
            if (step.kind == MoveKind::dwell) {
                Move move = next_move(MoveKind::dwell, position_mm_);
                move.dwell_s = step.dwell_s;
                append(move, subject);
            } else {
                go(step.kind, {above.x(), above.y(), step.z_mm}, subject);
            }
        }
    }

    void go(MoveKind kind, const Eigen::Vector3d& target_mm, const GcodeWord& subject) {
        Move move = next_move(kind, target_mm);
        if (kind != MoveKind::rapid) {
            move.feed_mm_s = feed_mm_s_;
            has_cut_ = true;
        }
        position_mm_ = target_mm;
        if (length_mm(move) > 0.0) {
            append(move, subject);
        }
    }

    /// Once for each, with the line of the first.
    void note(std::string_view what) {
        const auto is_same = [&](const std::string& told) { return told.ends_with(what); };
        if (std::none_of(notes_.begin(), notes_.end(), is_same)) {
            notes_.push_back(fmt::format("{}:{}: {}", file_name_, line_, what));
        }
    }

    /// G64 P, the path's tolerance, and M52 P1, the override acts: both are so here anyway.
    void check_other_use_of_p(const SortedBlock& block) const {
        const GcodeWord* value = block.address('P');
        const GcodeWord* switched = block.code(adaptive_feed);
        const bool blends = block.code(path_mode) != nullptr && tenths(*block.code(path_mode)) == 640;
        if (cycle_.has_value()) {
            return;  // it is the cycle's
        }
        if (value != nullptr && switched == nullptr && !blends) {
            fail(*value, "P in a block with G4, G64 or M52 only");
        }
        if (value != nullptr && switched != nullptr && value->value != 1.0) {
            fail(*value, "M52 P1: the override always acts here");
        }
        if (value != nullptr && switched == nullptr && !(value->value >= 0.0)) {
            fail(*value, "a tolerance of 0 or more");
        }
    }

    void run_dwell(const SortedBlock& block) {
        const GcodeWord* code = block.code(dwell);
        const GcodeWord* time = block.address('P');
        if (code == nullptr) {
            check_other_use_of_p(block);
            return;
        }
        if (time == nullptr) {
            fail(*code, "G4 with P, the dwell in seconds");
        }
        if (!(time->value >= 0.0 && time->value <= longest_dwell_s)) {
            fail(*time, "a dwell from 0 to 3600 s");
        }
        if (const GcodeWord* word = block.first_of("XYZIJR")) {
            fail(*word, "no motion in a block with G4");
        }
        if (time->value > 0.0) {
            Move move = next_move(MoveKind::dwell, position_mm_);
            move.dwell_s = time->value;
            append(move, *code);
        }
    }

    void run_motion(const SortedBlock& block) {
        const GcodeWord* word = block.first_of("XYZIJR");
        if (word == nullptr) {
            return;
        }
        if (!motion_.has_value()) {
            fail(*word, "G0, G1, G2 or G3 before it");
        }
        const GcodeWord& subject = block.code(motion) != nullptr ? *block.code(motion) : *word;
        const Eigen::Vector3d target_mm = target(block);
        Move move = next_move(*motion_, target_mm);
        if (is_arc(move)) {
            if (!is_xy_plane_) {
                fail(subject, "G17: arcs lie in the xy plane only");
            }
            set_centre(move, block, subject);
        } else if (const GcodeWord* stray = block.first_of("IJR")) {
            fail(*stray, "I, J and R with an arc (G2, G3) only");
        }
        if (move.kind != MoveKind::rapid) {
            require_cutting_conditions(subject);
            move.feed_mm_s = feed_mm_s_;
            has_cut_ = true;
        }
        position_mm_ = move.end_mm;
        if (length_mm(move) > 0.0) {
            append(move, subject);
        }
    }

    void require_cutting_conditions(const GcodeWord& subject) const {
        if (feed_mm_s_ <= 0.0) {
            fail(subject, "a feed F before the first feed move");
        }
        if (!spindle_on_ || spindle_speed_rad_s_ <= 0.0) {
            fail(subject, "a turning spindle (M3 and S above 0) before a feed move");
        }
    }

    Move next_move(MoveKind kind, const Eigen::Vector3d& target_mm) const {
        Move move;
        move.kind = kind;
        move.start_mm = position_mm_;
        move.end_mm = target_mm;
        move.spindle_speed_rad_s = spindle_on_ ? spindle_speed_rad_s_ : 0.0;
        move.line = line_;
        return move;
    }

    Eigen::Vector3d target(const SortedBlock& block) const {
        Eigen::Vector3d result = position_mm_;
        constexpr std::string_view axes = "XYZ";
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            if (const GcodeWord* word = block.address(axes[axis])) {
                double& coordinate = result[static_cast<Eigen::Index>(axis)];
                coordinate = word->value * mm_per_unit_ + (relative_ ? coordinate : 0.0);
                if (!(std::abs(coordinate) <= largest_coordinate_mm)) {
                    fail(*word, "a position within 100000 mm of the origin");
                }
            }
        }
        return result;
    }

    double offset_mm(const GcodeWord* word) const {
        if (word == nullptr) {
            return 0.0;
        }
        const double value = word->value * mm_per_unit_;
        if (!(std::abs(value) <= largest_coordinate_mm)) {
            fail(*word, "an arc's centre or radius within 100000 mm");
        }
        return value;
    }

    void set_centre(Move& move, const SortedBlock& block, const GcodeWord& subject) const {
        const GcodeWord* radius = block.address('R');
        const GcodeWord* centre = block.first_of("IJ");
        if (radius != nullptr && centre != nullptr) {
            fail(*radius, fmt::format("either a radius R or a centre I, J, not both ('{}')", centre->text));
        }
        if (radius == nullptr && centre == nullptr) {
            fail(subject, "an arc with a centre (I, J) or a radius (R) in the same block");
        }
        if (radius != nullptr) {
            set_centre_from_radius(move, *radius);
            return;
        }
        move.centre_mm =
            move.start_mm + Eigen::Vector3d(offset_mm(block.address('I')), offset_mm(block.address('J')), 0.0);
        if ((move.end_mm - move.start_mm).head<2>().norm() < coincident_mm) {
            move.end_mm.head<2>() = move.start_mm.head<2>();  // a full circle, whatever relative sums round to
        }
        const double start_radius_mm = (move.start_mm - move.centre_mm).head<2>().norm();
        const double end_radius_mm = (move.end_mm - move.centre_mm).head<2>().norm();
        if (!(start_radius_mm > arc_tolerance_mm)) {
            fail(*centre, "an arc radius above 0.005 mm");
        }
        if (!(std::abs(start_radius_mm - end_radius_mm) <= arc_tolerance_mm)) {
            fail(*centre,
                 fmt::format("the same radius at the arc's start ({:.4f} mm) and end ({:.4f} mm) within 0.005 mm",
                             start_radius_mm, end_radius_mm));
        }
    }

    void set_centre_from_radius(Move& move, const GcodeWord& word) const {
        const double signed_radius_mm = offset_mm(&word);
        const double radius_mm = std::abs(signed_radius_mm);
        const Eigen::Vector2d chord = (move.end_mm - move.start_mm).head<2>();
        const double chord_mm = chord.norm();
        if (!(radius_mm > arc_tolerance_mm)) {
            fail(word, "an arc radius above 0.005 mm");
        }
        if (!(chord_mm > 0.0)) {
            fail(word, "an end away from the start: a full circle needs its centre as I, J");
        }
        if (!(0.5 * chord_mm <= radius_mm + arc_tolerance_mm)) {
            fail(word, fmt::format("an arc radius of at least half the distance from start to end ({:.4f} mm)",
                                   0.5 * chord_mm));
        }
        const double height_mm = std::sqrt(std::max(0.0, (radius_mm - 0.5 * chord_mm) * (radius_mm + 0.5 * chord_mm)));
        const bool centre_on_left = (move.kind == MoveKind::arc_ccw) == (signed_radius_mm > 0.0);
        const Eigen::Vector2d left = Eigen::Vector2d(-chord.y(), chord.x()) / chord_mm;
        move.centre_mm = move.start_mm;
        move.centre_mm.head<2>() += 0.5 * chord + (centre_on_left ? height_mm : -height_mm) * left;
    }

    void append(const Move& move, const GcodeWord& subject) {
        if (moves_.size() >= max_moves_) {
            fail(subject, fmt::format("a program of at most {} moves", max_moves_));
        }
        moves_.push_back(move);
    }

    std::string_view file_name_;
    std::size_t max_moves_;
    std::vector<Move> moves_;
    std::vector<std::string> notes_;
    Eigen::Vector3d position_mm_;
    double start_height_mm_;
    std::optional<DrillingCycle> cycle_;
    double height_before_cycle_mm_ = 0.0;
    long coordinates_ = 0;  // in tenths; 0: not given
    double tool_ = 0.0;
    double selected_tool_ = 0.0;
    std::size_t line_ = 0;
    double mm_per_unit_ = 1.0;
    double feed_mm_s_ = 0.0;
    double spindle_speed_rad_s_ = 0.0;
    std::optional<MoveKind> motion_;
    bool has_bottom_ = false;
    bool has_retract_ = false;
    bool returns_to_retract_ = false;
    bool is_xy_plane_ = true;
    bool has_cut_ = false;
    bool relative_ = false;
    bool spindle_on_ = false;
    bool percent_seen_ = false;
    bool block_seen_ = false;
    bool ended_ = false;
};

}  // namespace

GcodeProgram read_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    Interpreter interpreter(file_name, settings);
    std::size_t line = 1;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        interpreter.run(split_block(text.substr(begin, end - begin), file_name, line));
        if (interpreter.ended()) {
            return {interpreter.take_moves(), interpreter.take_notes()};
        }
        begin = end + 1;
    }
    if (interpreter.may_end_here()) {
        interpreter.note_end();
        return {interpreter.take_moves(), interpreter.take_notes()};
    }
    reject({file_name, line, 1}, "", "the closing % of the program");
}

GcodeProgram read_gcode(std::istream& stream, std::string_view file_name, const GcodeSettings& settings) {
    std::string text;
    std::array<char, 65536> chunk{};
    while (stream.read(chunk.data(), chunk.size()) || stream.gcount() > 0) {
        text.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > largest_text_bytes) {
            throw host::InputError(
                fmt::format("{}: found more than {} bytes, expected a part program of at most 256 MiB", file_name,
                            largest_text_bytes));
        }
    }
    if (stream.bad()) {
        throw host::InputError(fmt::format("{}: found a read error, expected a readable part program", file_name));
    }
    return read_gcode(text, file_name, settings);
}

std::vector<Move> parse_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings) {
    return read_gcode(text, file_name, settings).moves;
}

}  // namespace millforce::sim
