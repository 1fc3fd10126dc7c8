// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace millforce::test {

/// The command line of a millforce, as exec() takes it.
class Arguments {
  public:
    explicit Arguments(const std::vector<std::string>& arguments) : words_{MILLFORCE_PROGRAM} {
        words_.insert(words_.end(), arguments.begin(), arguments.end());
        for (std::string& word : words_) {
            argv_.push_back(word.data());
        }
        argv_.push_back(nullptr);
    }
    Arguments(const Arguments&) = delete;
    Arguments& operator=(const Arguments&) = delete;

    [[nodiscard]] char* const* argv() const { return argv_.data(); }

  private:
    std::vector<std::string> words_;
    std::vector<char*> argv_{};
};

}  // namespace millforce::test
