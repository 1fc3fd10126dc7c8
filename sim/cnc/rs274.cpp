// SPDX-License-Identifier: Apache-2.0
#include "cnc/rs274.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

#include "cnc/arc_plane.hpp"
#include "cutting/angle_units.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/text_lines.hpp"

namespace millforce::sim {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t largest_output_bytes = std::size_t{256} << 20U;
constexpr std::chrono::seconds patience{60};

/// rs274's own table has three tools, some with a diameter by which it would shift a path under G41. This one has those
/// that LinuxCNC can number, without length and diameter: coordinates are those of the tip. Returns a descriptor.
int open_tool_table(const std::string& file) {
    constexpr int most_tools = 999;
    std::string table;
    for (int tool = 1; tool <= most_tools; ++tool) {
        table += fmt::format("T{0} P{0} Z0 D0\n", tool);
    }
    const int descriptor = ::memfd_create("tools", MFD_CLOEXEC);
    if (descriptor < 0 || ::write(descriptor, table.data(), table.size()) != static_cast<ssize_t>(table.size())) {
        throw host::InputError(fmt::format("{}: no memory for rs274's tool table", file));
    }
    return descriptor;
}

/// A line without comments and blanks, in upper case.
std::string code_of(std::string_view line) {
    std::string code;
    bool in_comment = false;
    for (const char letter : line) {
        in_comment = in_comment || letter == '(';
        if (letter == ';') {
            break;
        }
        if (!in_comment && letter != ' ' && letter != '\t') {
            code += static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
        }
        in_comment = in_comment && letter != ')';
    }
    return code;
}

/// The canonical commands do not say by which radius a path was shifted.
void require_no_compensation(const std::string& file) {
    std::ifstream program = host::open_to_read(file);
    std::size_t number = 0;
    for (std::string line; std::getline(program, line);) {
        ++number;
        const std::string code = code_of(line);
        for (const char* word : {"G41", "G42"}) {
            const std::size_t place = code.find(word);
            const char next = place == std::string::npos || place + 3 >= code.size() ? ' ' : code[place + 3];
            if (place != std::string::npos && std::isdigit(static_cast<unsigned char>(next)) == 0) {
                throw host::InputError(
                    fmt::format("{}:{}: found '{}', expected G40: let the CAM system compensate the cutter's radius",
                                file, number, word));
            }
        }
    }
}

// ---- The process -----------------------------------------------------------------------------------------------

/// A running rs274: its output and errors on pipes, its input at its end. Ended with the object.
class Rs274 {
  public:
    explicit Rs274(const std::string& file) : file_(file) {
        std::array<int, 2> out{};
        std::array<int, 2> error{};
        if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(error.data(), O_CLOEXEC) != 0) {
            throw host::InputError(fmt::format("{}: no pipe to rs274", file));
        }
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions, error[1], STDERR_FILENO);
        std::string program = "rs274";
        std::string batch = "-g";
        std::string name = std::filesystem::absolute(file).string();
        std::string option = "-t";
        std::string tools = "/dev/fd/3";
        const int table = open_tool_table(file);
        ::posix_spawn_file_actions_adddup2(&actions, table, 3);
        std::array<char*, 6> arguments{program.data(), option.data(), tools.data(), batch.data(), name.data(), nullptr};
        const int failed = ::posix_spawnp(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(table);
        ::close(out[1]);
        ::close(error[1]);
        pipes_ = {out[0], error[0]};
        if (failed != 0) {
            process_ = 0;
            throw host::InputError(fmt::format("{}: rs274 cannot be run; it is in LinuxCNC's package", file));
        }
    }
    ~Rs274() {
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            ::waitpid(process_, nullptr, 0);
        }
        ::close(pipes_[0]);
        ::close(pipes_[1]);
    }
    Rs274(const Rs274&) = delete;
    Rs274& operator=(const Rs274&) = delete;

    /// Its whole output; throws where it refuses.
    std::string output() {
        const auto deadline = Clock::now() + patience;
        std::array<pollfd, 2> waiting{{{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}}};
        while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
            if (left <= 0 || texts_[0].size() + texts_[1].size() > largest_output_bytes) {
                throw host::InputError(fmt::format("{}: rs274 does not come to an end; expected one within {} s", file_,
                                                   patience.count()));
            }
            ::poll(waiting.data(), waiting.size(), static_cast<int>(left));
            for (std::size_t k = 0; k < waiting.size(); ++k) {
                read_some(waiting[k], texts_[k]);
            }
        }
        int status = 0;
        ::waitpid(process_, &status, 0);
        process_ = 0;
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
            throw host::InputError(fmt::format("{}: rs274 refuses it: {}", file_, reason()));
        }
        return std::move(texts_[0]);
    }

  private:
    static void read_some(pollfd& waiting, std::string& text) {
        std::array<char, 65536> buffer{};
        if (waiting.fd < 0 || waiting.revents == 0) {
            return;
        }
        const ssize_t count = ::read(waiting.fd, buffer.data(), buffer.size());
        text.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        waiting.fd = count > 0 ? waiting.fd : -1;
    }

    /// Its words without the progress lines, in one line of printable text.
    [[nodiscard]] std::string reason() const {
        constexpr std::size_t longest = 200;
        std::string text;
        std::size_t begin = 0;
        const std::string& all = texts_[1];
        while (begin < all.size() && text.size() < longest) {
            const std::size_t end = std::min(all.find('\n', begin), all.size());
            const std::string line = all.substr(begin, end - begin);
            text += line == "executing" || line.empty() ? "" : (text.empty() ? "" : "; ") + line;
            begin = end + 1;
        }
        std::replace_if(
            text.begin(), text.end(), [](char letter) { return letter < ' ' || letter == 0x7F; }, '?');
        return text.empty() ? "without a word" : text.substr(0, longest);
    }

    std::string file_;
    pid_t process_ = 0;
    std::array<int, 2> pipes_{};
    std::array<std::string, 2> texts_;
};

// ---- Its canonical commands ------------------------------------------------------------------------------------

struct Command {
    std::string_view name;
    std::string_view arguments;
};

std::optional<Command> command_of(std::string_view line) {
    const std::size_t open = line.find('(');
    const std::size_t close = line.rfind(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) {
        return std::nullopt;
    }
    const std::size_t blank = line.rfind(' ', open);
    const std::size_t begin = blank == std::string_view::npos ? 0 : blank + 1;
    return Command{line.substr(begin, open - begin), line.substr(open + 1, close - open - 1)};
}

class CanonicalReader {
  public:
    CanonicalReader(const std::string& file, const GcodeSettings& settings)
        : file_(file),
          max_moves_(settings.max_moves),
          may_change_tool_(settings.may_change_tool),
          position_mm_(settings.start_mm) {}

    void run(const Command& command) {
        if (command.name == "USE_LENGTH_UNITS") {
            mm_per_unit_ = command.arguments == "CANON_UNITS_INCHES" ? mm_per_inch : 1.0;
        } else if (command.name == "SET_FEED_RATE") {
            set_feed(number(command, 0) * mm_per_unit_);
        } else if (command.name == "SET_SPINDLE_SPEED") {
            set_spindle_speed(number(command, 1));
        } else if (command.name == "START_SPINDLE_CLOCKWISE") {
            spindle_on_ = true;
        } else if (command.name == "START_SPINDLE_COUNTERCLOCKWISE") {
            fail("M4, expected M3: the cutter is right-handed and cuts clockwise only");
        } else if (command.name == "STOP_SPINDLE_TURNING") {
            spindle_on_ = false;
        } else if (command.name == "SELECT_PLANE") {
            plane_ = command.arguments == "CANON_PLANE_XY"   ? ArcPlane::xy
                     : command.arguments == "CANON_PLANE_XZ" ? ArcPlane::zx
                                                             : ArcPlane::yz;
        } else if (command.name == "CHANGE_TOOL") {
            change_tool(number(command, 0));
        } else {
            run_motion(command);
        }
    }

    std::vector<Move> take_moves() { return std::move(moves_); }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw host::InputError(fmt::format("{}: by rs274: found {}", file_, what));
    }

    void run_motion(const Command& command) {
        if (command.name == "STRAIGHT_TRAVERSE") {
            go(next_move(MoveKind::rapid, position(command, 0, 1, 2)));
        } else if (command.name == "STRAIGHT_FEED") {
            go(next_move(MoveKind::feed_line, position(command, 0, 1, 2)));
        } else if (command.name == "ARC_FEED") {
            run_arc(command);
        } else if (command.name == "DWELL") {
            dwell(number(command, 0));
        } else if (command.name == "STRAIGHT_PROBE" || command.name == "RIGID_TAP" || command.name == "NURBS_FEED" ||
                   command.name == "START_SPEED_FEED_SYNCH") {
            fail(fmt::format("{}, expected lines, arcs and dwells", command.name));
        }
    }

    /// ARC_FEED(end, centre, turns, end along the axis, …), end and centre in the plane's axes: turns > 0
    /// counter-clockwise.
    void run_arc(const Command& command) {
        const double turns = number(command, 4);
        if (std::abs(turns) != 1.0) {
            fail("an arc of more than one turn, expected one at most");
        }
        Move move = next_move(turns > 0.0 ? MoveKind::arc_ccw : MoveKind::arc_cw, position(command, 0, 1, 5));
        move.start_mm = in_plane(move.start_mm, plane_);
        move.centre_mm = {length(command, 2), length(command, 3), 0.0};
        for (const Move& part : moves_from_plane(move, plane_)) {
            go(part);
        }
    }

    void set_feed(double mm_min) {
        if (!(std::abs(mm_min) <= largest_feed_mm_min)) {
            fail(fmt::format("a feed of {} mm/min, expected at most {}", mm_min, largest_feed_mm_min));
        }
        feed_mm_s_ = mm_min / 60.0;
    }

    void set_spindle_speed(double rpm) {
        if (!(std::abs(rpm) <= largest_spindle_speed_rpm)) {
            fail(fmt::format("a spindle speed of {} rev/min, expected at most {}", rpm, largest_spindle_speed_rpm));
        }
        spindle_speed_rad_s_ = rpm * rad_s_per_rpm;
    }

    void dwell(double duration_s) {
        if (!(duration_s >= 0.0 && duration_s <= longest_dwell_s)) {
            fail(fmt::format("a dwell of {} s, expected one from 0 to {} s", duration_s, longest_dwell_s));
        }
        Move move = next_move(MoveKind::dwell, position_mm_);
        move.dwell_s = duration_s;
        append(move);
    }

    void change_tool(double tool) {
        if (!(tool >= 0.0 && tool <= largest_tool)) {
            fail(fmt::format("tool {}, expected one from 0 to {}", tool, largest_tool));
        }
        if (!may_change_tool_ && has_cut_ && tool != tool_) {
            fail(fmt::format("T{}, expected no other tool than T{}: a scenario has one", tool, tool_));
        }
        tool_ = tool;
    }

    [[nodiscard]] Move next_move(MoveKind kind, const Eigen::Vector3d& end_mm) const {
        Move move;
        move.kind = kind;
        move.start_mm = position_mm_;
        move.end_mm = end_mm;
        move.spindle_speed_rad_s = spindle_on_ ? spindle_speed_rad_s_ : 0.0;
        move.feed_mm_s = kind == MoveKind::rapid || kind == MoveKind::dwell ? 0.0 : feed_mm_s_;
        move.tool = static_cast<std::uint32_t>(tool_);
        return move;
    }

    void go(const Move& move) {
        if (move.kind != MoveKind::rapid) {
            if (!(feed_mm_s_ > 0.0)) {
                fail("a feed move without F");
            }
            if (!spindle_on_ || !(spindle_speed_rad_s_ > 0.0)) {
                fail("a feed move, expected a turning spindle (M3 and S above 0) before it");
            }
            has_cut_ = true;
        }
        if (!is_within_reach(move.end_mm)) {
            fail("a position beyond 100000 mm");
        }
        position_mm_ = move.end_mm;
        if (length_mm(move) > 0.0) {
            append(move);
        }
    }

    void append(const Move& move) {
        if (moves_.size() >= max_moves_) {
            fail(fmt::format("more than {} moves", max_moves_));
        }
        moves_.push_back(move);
    }

    [[nodiscard]] Eigen::Vector3d position(const Command& command, std::size_t x, std::size_t y, std::size_t z) const {
        return {length(command, x), length(command, y), length(command, z)};
    }
    [[nodiscard]] double length(const Command& command, std::size_t place) const {
        const double mm = number(command, place) * mm_per_unit_;
        if (!(std::abs(mm) <= largest_coordinate_mm)) {
            fail("a position beyond 100000 mm");
        }
        return mm;
    }
    [[nodiscard]] double number(const Command& command, std::size_t place) const {
        std::string_view rest = command.arguments;
        for (std::size_t k = 0; k < place && !rest.empty(); ++k) {
            const std::size_t comma = rest.find(',');
            rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
        }
        while (rest.starts_with(' ')) {
            rest.remove_prefix(1);
        }
        double value = 0.0;
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (error != std::errc{} || !std::isfinite(value)) {
            fail(fmt::format("{}({}), expected a number as argument {}", host::printable(command.name),
                             host::printable(command.arguments), place + 1));
        }
        return value;
    }

    std::string file_;
    std::size_t max_moves_;
    bool may_change_tool_;
    std::vector<Move> moves_;
    Eigen::Vector3d position_mm_;
    double mm_per_unit_ = 1.0;
    double feed_mm_s_ = 0.0;
    double spindle_speed_rad_s_ = 0.0;
    double tool_ = 0.0;
    bool spindle_on_ = false;
    ArcPlane plane_ = ArcPlane::xy;
    bool has_cut_ = false;
};

}  // namespace

bool has_rs274() {
    const char* path = std::getenv("PATH");
    std::string_view rest = path == nullptr ? "" : path;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        const std::string program = std::string(rest.substr(0, end)) + "/rs274";
        if (::access(program.c_str(), X_OK) == 0) {
            return true;
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

GcodeProgram moves_of_canonical(std::string_view text, const std::string& file, const GcodeSettings& settings) {
    CanonicalReader reader(file, settings);
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (const auto command = command_of(text.substr(begin, end - begin))) {
            reader.run(*command);
        }
        begin = end + 1;
    }
    return {reader.take_moves(),
            {fmt::format("{}: read by LinuxCNC's interpreter, rs274, without line numbers: no controller can follow a "
                         "part map of it",
                         file)}};
}

GcodeProgram read_by_rs274(const std::string& file, const GcodeSettings& settings) {
    require_no_compensation(file);
    return moves_of_canonical(Rs274(file).output(), file, settings);
}

}  // namespace millforce::sim
