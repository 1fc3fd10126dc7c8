// SPDX-License-Identifier: Apache-2.0
#include "bench_control/part_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace millforce::sim {

namespace {

/// Writes blank and program while the shape is drawn. The floor is at −depth, the blank's top at 0.
class Drawing {
  public:
    explicit Drawing(const BenchPart& part) : part_(part), radius_mm_(0.5 * part.tool_diameter_mm) {
        gcode_ = fmt::format("%\n(Benchmark part {}: {})\nG21 G90 G17 G40 G49 G80 G94\nS{:.0f} M3\nG0 Z5\n", part.name,
                             part.meaning, part.spindle_rpm);
        stock_.cell_mm = part.tool_diameter_mm > 10.0 ? 0.1 : 0.05;
        stock_.start_z_mm = 50.0;
    }

    [[nodiscard]] double radius_mm() const { return radius_mm_; }
    [[nodiscard]] double floor_mm() const { return -part_.depth_mm; }

    void block(double min_x_mm, double min_y_mm, double max_x_mm, double max_y_mm) {
        stock_.block = {min_x_mm, min_y_mm, max_x_mm, max_y_mm, 0.0, 0.0};
        stock_.start_x_mm = min_x_mm - 30.0;
        stock_.start_y_mm = min_y_mm - 20.0;
    }
    /// Within the block, from one height to another along x.
    void height(double from_x_mm, double to_x_mm, double top_start_mm, double top_end_mm) {
        const StockBox& block = stock_.block;
        stock_.boxes.push_back({from_x_mm, block.min_y_mm, to_x_mm, block.max_y_mm, top_start_mm, top_end_mm});
    }
    void gap(double from_x_mm, double to_x_mm) { height(from_x_mm, to_x_mm, through_mm, through_mm); }
    void cut_away(double from_x_mm, double from_y_mm, double to_x_mm, double to_y_mm) {
        stock_.boxes.push_back({from_x_mm, from_y_mm, to_x_mm, to_y_mm, through_mm, through_mm});
    }
    void hole(double x_mm, double y_mm, double diameter_mm) {
        stock_.drilled.push_back({x_mm, y_mm, diameter_mm, floor_mm()});
    }

    /// Down to the floor in air.
    void start_at(double x_mm, double y_mm) {
        gcode_ += fmt::format("G0 X{:.3f} Y{:.3f}\nG0 Z{:.3f}\nF{:.0f}\n", x_mm, y_mm, floor_mm(),
                              programmed_feed_mm_min(part_));
    }
    /// Down a drilled hole, wide enough for a blank that lies 1 mm off, and slowly at last.
    void start_in_hole(double x_mm, double y_mm) {
        hole(x_mm, y_mm, part_.tool_diameter_mm + 3.0);
        gcode_ += fmt::format("G0 X{:.3f} Y{:.3f}\nG0 Z{:.3f}\nF600\nG1 Z{:.3f}\nF{:.0f}\n", x_mm, y_mm,
                              floor_mm() + 1.0, floor_mm(), programmed_feed_mm_min(part_));
    }
    void line(double x_mm, double y_mm) { gcode_ += fmt::format("G1 X{:.3f} Y{:.3f}\n", x_mm, y_mm); }
    void rapid_over(double x_mm, double y_mm) {
        gcode_ += fmt::format("G0 Z5\nG0 X{:.3f} Y{:.3f}\nG0 Z{:.3f}\n", x_mm, y_mm, floor_mm());
    }
    /// A full circle around the origin's offset from where the tool stands.
    void circle(double x_mm, double y_mm, double to_centre_x_mm, double to_centre_y_mm, bool clockwise) {
        gcode_ += fmt::format("{} X{:.4f} Y{:.4f} I{:.4f} J{:.4f}\n", clockwise ? "G2" : "G3", x_mm, y_mm,
                              to_centre_x_mm, to_centre_y_mm);
    }

    [[nodiscard]] PartProgram finished() {
        gcode_ += "G0 Z5\nM5\nM30\n%\n";
        return {stock_, gcode_};
    }

  private:
    static constexpr double through_mm = -50.0;

    BenchPart part_;
    double radius_mm_;
    StockSettings stock_;
    std::string gcode_;
};

/// From the edge of a blank so far that the tool is clear of it, also when the blank lies a little off.
double clear_mm(const Drawing& drawing) {
    return drawing.radius_mm() + 3.0;
}

/// Counter-clockwise and outwards from a drilled hole: a slot, then walls, with the wall on the right: down milling.
void draw_spiral(Drawing& d, const BenchPart& part) {
    const double half_x = 0.5 * part.length_mm - d.radius_mm();
    const double half_y = 0.5 * part.breadth_mm - d.radius_mm();
    const double slot = std::max(half_x - half_y, 0.0);
    d.block(-0.5 * part.length_mm - 4.0, -0.5 * part.breadth_mm - 4.0, 0.5 * part.length_mm + 4.0,
            0.5 * part.breadth_mm + 4.0);
    d.start_in_hole(0.0, 0.0);
    d.line(-slot, 0.0);
    d.line(slot, 0.0);
    const int rings = static_cast<int>(std::ceil(half_y / part.width_mm));
    double below = 0.0;
    for (int ring = 1; ring <= rings; ++ring) {
        const double y = std::min(ring * part.width_mm, half_y);
        d.line(slot + y, -below);
        d.line(slot + y, y);
        d.line(-slot - y, y);
        d.line(-slot - y, -y);
        below = y;
    }
    d.line(slot + half_y, -half_y);
}

/// Back and forth along x: slots first, then down and up milling in turn.
void draw_long_way(Drawing& d, const BenchPart& part) {
    const double half_x = 0.5 * part.length_mm - d.radius_mm();
    const double half_y = 0.5 * part.breadth_mm - d.radius_mm();
    d.block(-0.5 * part.length_mm - 4.0, -0.5 * part.breadth_mm - 4.0, 0.5 * part.length_mm + 4.0,
            0.5 * part.breadth_mm + 4.0);
    d.start_in_hole(-half_x, -half_y);
    double end_x = half_x;
    double y = -half_y;
    while (true) {
        d.line(end_x, y);
        if (y >= half_y - 1e-6) {
            break;
        }
        y = std::min(y + part.width_mm, half_y);
        d.line(end_x, y);
        end_x = -end_x;
    }
}

/// Straight through a block that is wider than the tool.
void draw_slot(Drawing& d, const BenchPart& part) {
    const double side = d.radius_mm() + 6.0;
    d.block(0.0, -side, part.length_mm, side);
    d.start_at(-clear_mm(d), 0.0);
    d.line(part.length_mm + clear_mm(d), 0.0);
}

void draw_shoulder(Drawing& d, const BenchPart& part) {
    draw_slot(d, part);
    const double side = d.radius_mm() + 6.0;
    d.cut_away(0.3 * part.length_mm, 0.0, 0.65 * part.length_mm, side);
}

void draw_step(Drawing& d, const BenchPart& part) {
    draw_slot(d, part);
    d.height(0.0, 0.5 * part.length_mm, -0.5 * part.depth_mm, -0.5 * part.depth_mm);
}

void draw_turn(Drawing& d, const BenchPart& part) {
    const double side = d.radius_mm() + 6.0;
    d.block(0.0, -side, part.length_mm, part.breadth_mm);
    d.start_at(-clear_mm(d), 0.0);
    d.line(part.length_mm - side, 0.0);
    d.line(part.length_mm - side, part.breadth_mm + clear_mm(d));
}

/// A wall on the right of the path, of which `width_mm` is cut away: down milling.
void wall(Drawing& d, const BenchPart& part) {
    d.block(0.0, -d.radius_mm() - 6.0, part.length_mm, -d.radius_mm() + part.width_mm);
}

void pass_along_wall(Drawing& d, const BenchPart& part) {
    d.start_at(-clear_mm(d), 0.0);
    d.line(part.length_mm + clear_mm(d), 0.0);
}

void draw_equal_ribs(Drawing& d, const BenchPart& part) {
    wall(d, part);
    const double rib_mm = 1.2 * part.tool_diameter_mm;
    double x = rib_mm;
    while (x < part.length_mm) {
        d.gap(x, std::min(x + rib_mm, part.length_mm));
        x += 2.0 * rib_mm;
    }
    pass_along_wall(d, part);
}

void draw_growing_ribs(Drawing& d, const BenchPart& part) {
    wall(d, part);
    double rib_mm = 4.0;
    double x = rib_mm;
    while (x < part.length_mm) {
        d.gap(x, std::min(x + part.tool_diameter_mm, part.length_mm));
        rib_mm += 6.0;
        x += part.tool_diameter_mm + rib_mm;
    }
    pass_along_wall(d, part);
}

/// Past the same ribs three times; the width of each pass is 0.5, 1 and 1.5 times the stated one.
void draw_rib_passes(Drawing& d, const BenchPart& part) {
    d.block(0.0, -d.radius_mm() - 6.0, part.length_mm, -d.radius_mm() + 3.0 * part.width_mm);
    double x = 20.0;
    while (x < part.length_mm) {
        d.gap(x, x + 25.0);
        x += 50.0;
    }
    double y = 2.5 * part.width_mm;
    d.start_at(-clear_mm(d), y);
    d.line(part.length_mm + clear_mm(d), y);
    for (const double width : {1.0, 1.5}) {
        y -= width * part.width_mm;
        d.rapid_over(-clear_mm(d), y);
        d.line(part.length_mm + clear_mm(d), y);
    }
}

/// Paths along x that cover the block from its upper edge downwards.
std::vector<double> face_paths(const Drawing& d, const BenchPart& part) {
    std::vector<double> paths;
    double y = part.breadth_mm - part.width_mm + d.radius_mm();
    while (y > -d.radius_mm()) {
        paths.push_back(y);
        y -= part.width_mm;
    }
    return paths;
}

void draw_zigzag(Drawing& d, const BenchPart& part) {
    d.block(0.0, 0.0, part.length_mm, part.breadth_mm);
    double from = -clear_mm(d);
    double to = part.length_mm + clear_mm(d);
    const std::vector<double> paths = face_paths(d, part);
    d.start_at(from, paths.front());
    for (const double y : paths) {
        d.line(from, y);
        d.line(to, y);
        std::swap(from, to);
    }
}

void draw_holes(Drawing& d, const BenchPart& part) {
    draw_zigzag(d, part);
    d.hole(0.3 * part.length_mm, 0.5 * part.breadth_mm, 1.2 * part.tool_diameter_mm);
    d.hole(0.7 * part.length_mm, 0.5 * part.breadth_mm, 0.8 * part.tool_diameter_mm);
}

/// Against x, so that the block is on the left of each path: up milling.
void draw_one_way(Drawing& d, const BenchPart& part) {
    d.block(0.0, 0.0, part.length_mm, part.breadth_mm);
    const double from = part.length_mm + clear_mm(d);
    const std::vector<double> paths = face_paths(d, part);
    d.start_at(from, paths.front());
    for (const double y : paths) {
        if (y < paths.front()) {
            d.rapid_over(from, y);
        }
        d.line(-clear_mm(d), y);
    }
}

void draw_ramp(Drawing& d, const BenchPart& part) {
    wall(d, part);
    const double shallow = d.floor_mm() + 0.2 * part.depth_mm;
    d.height(0.0, 0.5 * part.length_mm, shallow, 0.0);
    d.height(0.5 * part.length_mm, part.length_mm, 0.0, shallow);
    pass_along_wall(d, part);
}

/// Steps of depth in shares of the deepest, all of the same length.
void draw_depths(Drawing& d, const BenchPart& part, std::initializer_list<double> shares) {
    wall(d, part);
    const double step_mm = part.length_mm / static_cast<double>(shares.size());
    double x = 0.0;
    for (const double share : shares) {
        const double top = d.floor_mm() + share * part.depth_mm;
        d.height(x, x + step_mm, top, top);
        x += step_mm;
    }
    pass_along_wall(d, part);
}

/// From the first place to the last, both counted, in steps; a step below 0 goes down.
[[nodiscard]] std::vector<double> places(double first_mm, double last_mm, double step_mm) {
    const double steps = std::floor((last_mm - first_mm) / step_mm + 1e-6);
    std::vector<double> result;
    for (int k = 0; k <= static_cast<int>(steps); ++k) {
        result.push_back(first_mm + k * step_mm);
    }
    return result;
}

/// Counter-clockwise circles that grow from a drilled hole: down milling.
void draw_outwards(Drawing& d, const BenchPart& part) {
    const double edge = 0.5 * part.length_mm + 4.0;
    d.block(-edge, -edge, edge, edge);
    d.start_in_hole(0.0, 0.0);
    const double last = 0.5 * part.length_mm - d.radius_mm();
    for (const double r : places(part.width_mm, last, part.width_mm)) {
        d.line(r, 0.0);
        d.circle(r, 0.0, -r, 0.0, false);
    }
    d.line(0.0, 0.0);
}

/// Small counter-clockwise circles, each further along the slot.
void draw_trochoid(Drawing& d, const BenchPart& part) {
    const double r = 0.5 * part.breadth_mm - d.radius_mm();
    d.block(0.0, -0.5 * part.breadth_mm - 5.0, part.length_mm, 0.5 * part.breadth_mm + 5.0);
    const double first = -clear_mm(d) - r + 2.0;
    d.start_at(first + r, 0.0);
    for (const double x : places(first, part.length_mm - part.width_mm, part.width_mm)) {
        d.line(x + r, 0.0);
        d.circle(x + r, 0.0, -r, 0.0, false);
    }
}

/// Clockwise around, inwards: the corners of a square block, then a round boss of half its length.
void draw_boss(Drawing& d, const BenchPart& part) {
    const double edge = 0.5 * part.length_mm;
    d.block(-edge, -edge, edge, edge);
    const double first = std::numbers::sqrt2 * edge + d.radius_mm() - 2.0 * part.width_mm;
    const double last = 0.5 * edge + d.radius_mm() + part.width_mm;
    d.start_at(first + part.width_mm + 2.0, -0.1);
    for (const double r : places(first, last, -part.width_mm)) {
        d.line(r, 0.0);
        d.circle(r, 0.0, -r, 0.0, true);
    }
    d.line(edge + clear_mm(d) + d.radius_mm(), 0.0);
}

/// A square ring around an island: a slot first that closes into its own start, then outwards, step by step.
void draw_island(Drawing& d, const BenchPart& part) {
    const double edge = 0.5 * part.length_mm + 4.0;
    d.block(-edge, -edge, edge, edge);
    const double last = 0.5 * part.length_mm - d.radius_mm();
    const double first = last - 3.0 * part.width_mm;
    d.start_in_hole(first, 0.0);
    for (const double half : places(first, last, part.width_mm)) {
        d.line(half, 0.0);
        d.line(half, half);
        d.line(-half, half);
        d.line(-half, -half);
        d.line(half, -half);
        d.line(half, 0.0);
    }
}

void draw_stairs(Drawing& d, const BenchPart& part) {
    draw_depths(d, part, {0.4, 0.6, 0.8, 1.0});
}

void draw_doubling(Drawing& d, const BenchPart& part) {
    draw_depths(d, part, {0.125, 0.25, 0.5, 1.0, 0.5});
}

struct Shape {
    std::string_view name;
    void (*draw)(Drawing&, const BenchPart&);
};

constexpr Shape shapes[] = {
    {"spiral", draw_spiral},     {"long_way", draw_long_way},
    {"plain", draw_slot},        {"shoulder", draw_shoulder},
    {"step", draw_step},         {"turn", draw_turn},
    {"equal", draw_equal_ribs},  {"growing", draw_growing_ribs},
    {"passes", draw_rib_passes}, {"zigzag", draw_zigzag},
    {"holes", draw_holes},       {"one_way", draw_one_way},
    {"ramp", draw_ramp},         {"stairs", draw_stairs},
    {"doubling", draw_doubling}, {"outwards", draw_outwards},
    {"trochoid", draw_trochoid}, {"boss", draw_boss},
    {"island", draw_island},
};

}  // namespace

PartProgram program_of_part(const BenchPart& part) {
    Drawing drawing(part);
    const auto* shape = std::ranges::find(shapes, part.shape, &Shape::name);
    if (shape == std::end(shapes)) {
        throw std::logic_error(fmt::format("no shape '{}'", part.shape));
    }
    shape->draw(drawing, part);
    return drawing.finished();
}

}  // namespace millforce::sim
