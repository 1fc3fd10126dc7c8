// SPDX-License-Identifier: Apache-2.0
#include "reproduce/papers.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

namespace millforce::sim {

namespace {

constexpr std::array all_papers{
    Paper{"hwang", reproduce_hwang, 20.0}, Paper{"yang", reproduce_yang, 15.0},
    Paper{"kim", reproduce_kim, 10.0},     Paper{"roughness", reproduce_roughness, 0.5},
    Paper{"guan", reproduce_guan, 3.0},
};

/// Shared by the workers: which paper is next, which ones run, and their results.
class Work {
  public:
    explicit Work(std::span<const Paper> chosen) : chosen_(chosen), order_(chosen.size()), results_(chosen.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(),
                         [&](std::size_t a, std::size_t b) { return chosen_[a].typical_s > chosen_[b].typical_s; });
    }

    void run_all() {
        for (std::size_t k = take(); k < chosen_.size(); k = take()) {
            try {
                finish(k, chosen_[k].reproduce());
            } catch (...) {
                fail(std::current_exception());
            }
        }
    }

    [[nodiscard]] std::vector<std::string_view> running() {
        const std::scoped_lock lock(mutex_);
        return running_;
    }
    [[nodiscard]] bool done() {
        const std::scoped_lock lock(mutex_);
        return next_ >= order_.size() && running_.empty();
    }
    [[nodiscard]] std::vector<Reproduction> results() {
        if (failure_) {
            std::rethrow_exception(failure_);
        }
        return std::move(results_);
    }

  private:
    std::size_t take() {
        const std::scoped_lock lock(mutex_);
        if (next_ >= order_.size()) {
            return chosen_.size();
        }
        const std::size_t k = order_[next_++];
        running_.push_back(chosen_[k].name);
        return k;
    }
    void finish(std::size_t k, Reproduction result) {
        const std::scoped_lock lock(mutex_);
        results_[k] = std::move(result);
        std::erase(running_, chosen_[k].name);
    }
    void fail(std::exception_ptr failure) {
        const std::scoped_lock lock(mutex_);
        failure_ = std::move(failure);
        next_ = order_.size();
        running_.clear();
    }

    std::span<const Paper> chosen_;
    std::vector<std::size_t> order_;
    std::vector<Reproduction> results_;
    std::vector<std::string_view> running_;
    std::size_t next_ = 0;
    std::exception_ptr failure_;
    std::mutex mutex_;
};

}  // namespace

std::span<const Paper> papers() {
    return all_papers;
}

std::vector<Reproduction> reproduce(std::span<const Paper> chosen,
                                    const std::function<void(const std::vector<std::string_view>& running)>& watch) {
    Work work(chosen);
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> workers;
    for (std::size_t k = 0; k < std::min(cores, chosen.size()); ++k) {
        workers.emplace_back([&work] { work.run_all(); });
    }
    while (!work.done()) {
        watch(work.running());
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    workers.clear();
    return work.results();
}

}  // namespace millforce::sim
