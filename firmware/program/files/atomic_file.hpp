// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>

namespace millforce::host {

/// A file that appears whole or not at all.
///
/// Text goes to a temporary file next to the target; commit() flushes it to the disk and renames it over the target in
/// one step. Without commit() – an exception, a refusal – the destructor removes the temporary file, and a target from
/// an earlier run stays as it was. Errors (no folder, no permission, disk full) are InputErrors that name the file.
///
///     AtomicFile file("out.csv");
///     file.stream() << "time_s\n";
///     file.commit();
///
/// Not thread-safe. At most 16 may be open at once.
class AtomicFile {
  public:
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    std::ostream& stream() { return stream_; }

    /// Makes the target appear. Throws, and leaves the target as it was, where a write has failed.
    void commit();

  private:
    class Buffer : public std::streambuf {
      public:
        explicit Buffer(int descriptor);
        bool flush();

      protected:
        int_type overflow(int_type letter) override;
        int sync() override;

      private:
        int descriptor_;
        std::vector<char> memory_;
    };

    void discard();

    std::filesystem::path target_;
    std::string temporary_;
    int descriptor_;
    std::size_t slot_;
    Buffer buffer_;
    std::ostream stream_;
    bool open_ = true;
};

/// Makes SIGINT (Ctrl-C), SIGTERM, SIGHUP and SIGPIPE remove the temporary files of all open AtomicFiles before they
/// end the program as usual. Call once, at the start of main().
void remove_unfinished_files_on_interrupt();

/// What the signal handler does; async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace millforce::host
