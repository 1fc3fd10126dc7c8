// SPDX-License-Identifier: Apache-2.0
#include "daemon/line_printer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include <CppUTest/TestHarness.h>

using namespace millforce::host;

namespace {

/// A pipe that nobody reads yet, and that takes no byte more.
class FullPipe {
  public:
    FullPipe() {
        CHECK_EQUAL(0, pipe(ends_.data()));
        fcntl(ends_[1], F_SETFL, O_NONBLOCK);
        for (const char byte = '.'; write(ends_[1], &byte, 1) == 1;) {
            ++filled_;
        }
        fcntl(ends_[1], F_SETFL, 0);
        stream = fdopen(ends_[1], "w");
    }
    ~FullPipe() { close(ends_[0]); }
    FullPipe(const FullPipe&) = delete;
    FullPipe& operator=(const FullPipe&) = delete;

    /// What comes after the filling, to the end.
    std::string rest() const {
        std::string text;
        std::array<char, 4096> chunk{};
        for (ssize_t n = 0; (n = read(ends_[0], chunk.data(), chunk.size())) > 0;) {
            text.append(chunk.data(), static_cast<std::size_t>(n));
        }
        return text.substr(filled_);
    }

    std::FILE* stream = nullptr;

  private:
    std::array<int, 2> ends_{};
    std::size_t filled_ = 0;
};

}  // namespace

TEST_GROUP(LinePrinter){};

TEST(LinePrinter, does_not_wait_for_who_takes_no_line_and_says_how_many_are_missing) {
    FullPipe pipe;
    auto printer = std::make_unique<LinePrinter>(pipe.stream);
    constexpr int lines = 1000;
    for (int k = 0; k < lines; ++k) {
        printer->print("line {}", k);
    }
    std::string taken;
    std::thread reader([&] { taken = pipe.rest(); });
    printer.reset();
    std::fclose(pipe.stream);
    reader.join();
    int written = 0;
    int missing = 0;
    std::istringstream text(taken);
    for (std::string line; std::getline(text, line);) {
        int count = 0;
        written += line.starts_with("line ") ? 1 : 0;
        missing += std::sscanf(line.c_str(), "millforce: %d lines are missing here", &count) == 1 ? count : 0;
    }
    CHECK(written >= static_cast<int>(LinePrinter::capacity));
    LONGS_EQUAL(lines, written + missing);
    CHECK(taken.ends_with("lines are missing here: nobody took them\n"));
}

TEST(LinePrinter, writes_every_line_that_was_printed_before_its_end) {
    std::FILE* file = std::tmpfile();
    {
        LinePrinter printer(file);
        printer.print("one");
        printer.print(std::string(2 * LinePrinter::longest_line, 'x'));
        printer.print("{}", std::string(2 * LinePrinter::longest_line, 'y'));
    }
    std::rewind(file);
    std::array<char, 1024> text{};
    const std::size_t length = std::fread(text.data(), 1, text.size(), file);
    std::fclose(file);
    CHECK(std::string(text.data(), length) == "one\n" + std::string(LinePrinter::longest_line, 'x') + "\n" +
                                                  std::string(LinePrinter::longest_line, 'y') + "\n");
}
