// SPDX-License-Identifier: Apache-2.0
#include "bench_control/parallel.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace millforce::sim {

namespace {

class Work {
  public:
    Work(std::size_t count, const std::function<void(std::size_t)>& body) : count_(count), body_(body) {}

    void run() {
        for (std::size_t k = next_++; k < count_; k = next_++) {
            try {
                body_(k);
            } catch (...) {
                const std::lock_guard lock(mutex_);
                error_ = error_ ? error_ : std::current_exception();
                next_ = count_;
            }
            const std::lock_guard lock(mutex_);
            ++done_;
        }
        const std::lock_guard lock(mutex_);
        ++ended_;
        changed_.notify_one();
    }

    void wait_for(unsigned threads, const std::function<void(double)>& progress) {
        std::unique_lock lock(mutex_);
        while (!changed_.wait_for(lock, std::chrono::milliseconds(200), [&] { return ended_ == threads; })) {
            progress(static_cast<double>(done_) / static_cast<double>(count_));
        }
    }

    void rethrow() const {
        if (error_) {
            std::rethrow_exception(error_);
        }
    }

  private:
    std::size_t count_;
    const std::function<void(std::size_t)>& body_;
    std::atomic<std::size_t> next_{0};
    std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t done_ = 0;
    unsigned ended_ = 0;
    std::exception_ptr error_;
};

}  // namespace

void run_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body,
                  const std::function<void(double)>& progress) {
    Work work(count, body);
    {
        std::vector<std::jthread> workers;
        for (unsigned k = 0; k < threads; ++k) {
            workers.emplace_back([&work] { work.run(); });
        }
        work.wait_for(threads, progress);
    }
    work.rethrow();
}

}  // namespace millforce::sim
