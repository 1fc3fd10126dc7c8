// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// Arm semihosting: what an image under test asks of the emulator that runs it. Images for a machine have none of it.
/// Semihosting for AArch32 and AArch64, Arm IHI 0072.

namespace millforce::target {

/// The raw call; its meaning depends on `operation`.
std::int32_t semihosting(std::uint32_t operation, const void* argument);

void write_text(const char* text);
void write_number(std::uint32_t value);
[[noreturn]] void exit_emulator(int code);

enum class OpenMode : std::uint32_t { read_binary = 1, write_binary = 5 };

/// A file of the host; handle −1: could not be opened.
class HostFile {
  public:
    HostFile(const char* path, OpenMode mode);
    [[nodiscard]] bool is_open() const { return handle_ >= 0; }
    /// Blocks until all bytes are there. False at the end of the file.
    bool read(void* bytes, std::size_t count);
    bool write(const void* bytes, std::size_t count);

  private:
    std::int32_t handle_;
};

/// The command line that the emulator was given; empty where none was.
void read_command_line(char* text, std::size_t capacity);

}  // namespace millforce::target
