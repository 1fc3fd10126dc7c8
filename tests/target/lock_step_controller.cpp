// SPDX-License-Identifier: Apache-2.0
// The controller in lock-step with a plant on the host: ELF REQUESTS ANSWERS, the names of two pipes. Takes the
// parameters first, then a request and gives an answer, until the pipe ends. Exit code 3: a pipe could not be opened.

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "common/processor.hpp"
#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"
#include "firmware/tick.hpp"
#include "target/instruction_counter.hpp"
#include "target/lock_step.hpp"
#include "target/semihosting.hpp"

namespace {

using namespace millforce;
using Tick = firmware::SmallTick<MILLFORCE_SCALAR>;

char command_line[512];
firmware::ParameterValues parameter_values;

/// The command line's next word after `text`, which is cut off behind it.
char* next_word(char* text) {
    char* const space = std::strchr(text, ' ');
    if (space == nullptr) {
        target::exit_emulator(2);
    }
    *space = '\0';
    return space + 1;
}

/// Kept as a function of its own, so that only its instructions are counted; so is counted_slice().
[[gnu::noipa]] hal::FeedOverride counted_step(Tick& tick, const lock_step::Request& request) {
    return tick.step(request.sample, request.program);
}

[[gnu::noipa]] void counted_slice(Tick& tick) {
    tick.work();
}

/// All the work that is due. Returns the instructions of the longest slice.
std::uint32_t finish_work(Tick& tick, const target::InstructionCounter& counter) {
    std::uint32_t longest = 0;
    while (tick.work_due()) {
        const std::uint32_t start = counter.now();
        counted_slice(tick);
        longest = std::max(longest, counter.since(start));
    }
    return longest;
}

void serve(target::HostFile& requests, target::HostFile& answers) {
    static Tick tick(firmware::parameters_of<MILLFORCE_SCALAR>(parameter_values));
    const target::InstructionCounter counter;
    lock_step::Request request{};
    while (requests.read(&request, sizeof(request))) {
        const std::uint32_t start = counter.now();
        const hal::FeedOverride feed = counted_step(tick, request);
        const std::uint32_t of_step = counter.since(start);
        const std::uint32_t of_slice = finish_work(tick, counter);
        lock_step::Answer answer = lock_step::answer_of(tick, feed);
        answer.instructions = of_step + of_slice;
        if (!answers.write(&answer, sizeof(answer))) {
            return;
        }
    }
}

}  // namespace

void millforce::board::run_image() {
    target::read_command_line(command_line, sizeof(command_line));
    char* const requests_name = next_word(command_line);
    char* const answers_name = next_word(requests_name);
    target::HostFile requests(requests_name, target::OpenMode::read_binary);
    target::HostFile answers(answers_name, target::OpenMode::write_binary);
    if (!requests.is_open() || !answers.is_open() || !requests.read(&parameter_values, sizeof(parameter_values))) {
        target::exit_emulator(3);
    }
    serve(requests, answers);
    target::exit_emulator(0);
}
