// SPDX-License-Identifier: Apache-2.0
#include "daemon/line_printer.hpp"

#include <algorithm>

#include "files/console.hpp"

namespace millforce::host {

LinePrinter::LinePrinter(std::FILE* stream) : stream_(stream) {
    writer_ = std::thread([this] { run(); });
}

LinePrinter::~LinePrinter() {
    ended_.store(true);
    has_news_.release();
    writer_.join();
    report_lost(lost_);
}

void LinePrinter::print(std::string_view line) noexcept {
    Line entry;
    entry.length = std::min(line.size(), longest_line);
    std::copy_n(line.begin(), entry.length, entry.text.begin());
    entry.lost_before = lost_;
    if (lines_.push(entry)) {
        has_news_.release();
    } else {
        ++lost_;
    }
}

void LinePrinter::run() {
    while (!ended_.load()) {
        has_news_.acquire();
        write_all();
    }
    write_all();
}

void LinePrinter::write_all() {
    for (Line line; lines_.pop(line);) {
        report_lost(line.lost_before);
        print_line(stream_, std::string_view(line.text.data(), line.length));
    }
}

void LinePrinter::report_lost(std::uint64_t lost) {
    if (lost != reported_lost_) {
        Text line{};
        print_line(stream_,
                   written_into(line, "millforce: {} lines are missing here: nobody took them", lost - reported_lost_));
        reported_lost_ = lost;
    }
}

}  // namespace millforce::host
