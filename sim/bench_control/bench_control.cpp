// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_control.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <span>

#include "bench_control/journal.hpp"
#include "bench_control/parallel.hpp"
#include "bench_control/tuning.hpp"
#include "files/results_folder.hpp"
#include "firmware/crc32.hpp"

namespace millforce::sim {

namespace {

std::uint32_t crc_of(std::uint32_t crc, std::string_view bytes) {
    return firmware::crc32(crc, std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

/// Of this program's file: another build may have another control law.
std::uint32_t program_crc() {
    std::ifstream file("/proc/self/exe", std::ios::binary);
    std::array<char, 65536> block{};
    std::uint32_t crc = 0;
    while (file.read(block.data(), block.size()), file.gcount() > 0) {
        crc = crc_of(crc, {block.data(), static_cast<std::size_t>(file.gcount())});
    }
    return crc;
}

struct Job {
    std::size_t part;
    const Contender* contender;
    std::uint64_t seed;
};

std::vector<Job> jobs_left(const BenchSettings& settings, const Journal& journal) {
    std::vector<Job> jobs;
    for (int k = 0; k < settings.seeds; ++k) {
        const std::uint64_t seed = settings.first_seed + static_cast<std::uint64_t>(k);
        for (std::size_t part = 0; part < settings.parts.size(); ++part) {
            for (const Contender* contender : settings.contenders) {
                if (!journal.has(settings.parts[part].name, contender->name, seed)) {
                    jobs.push_back({part, contender, seed});
                }
            }
        }
    }
    return jobs;
}

void run_jobs(const BenchSettings& settings, const std::vector<Job>& jobs, Journal& journal,
              const BenchProgress& progress) {
    if (jobs.empty()) {
        return;
    }
    BenchSettings needed = settings;
    std::set<std::size_t> parts;
    for (const Job& job : jobs) {
        parts.insert(job.part);
    }
    std::vector<std::size_t> place(settings.parts.size());
    needed.parts.clear();
    for (const std::size_t part : parts) {
        place[part] = needed.parts.size();
        needed.parts.push_back(settings.parts[part]);
    }
    std::vector<PreparedPart> prepared = prepare_all(needed, progress);
    run_parallel(
        prepared.size(), settings.threads, [&](std::size_t k) { teach(prepared[k], settings.rules); },
        [&](double share) { progress("teaching the parts", share); });
    run_parallel(
        jobs.size(), settings.threads,
        [&](std::size_t k) {
            const Job& job = jobs[k];
            const PreparedPart& part = prepared[place[job.part]];
            journal.add(run_contender(*job.contender, part, job.seed, settings.rules, settings.traces));
        },
        [&](double share) { progress("milling", share); });
}

bool is_asked_for(const BenchRun& run, const BenchSettings& settings) {
    const std::uint64_t end = settings.first_seed + static_cast<std::uint64_t>(settings.seeds);
    return run.seed >= settings.first_seed && run.seed < end &&
           std::ranges::any_of(settings.parts, [&](const BenchPart& part) { return part.name == run.part; }) &&
           std::ranges::any_of(settings.contenders, [&](const Contender* c) { return c->name == run.controller; });
}

}  // namespace

std::vector<PreparedPart> prepare_all(const BenchSettings& settings, const BenchProgress& progress) {
    const std::filesystem::path folder = host::results_folder((settings.out / "parts").string(), "vmc.toml");
    std::vector<PreparedPart> prepared(settings.parts.size());
    run_parallel(
        prepared.size(), settings.threads, [&](std::size_t k) { prepared[k] = prepare(folder, settings.parts[k]); },
        [&](double share) { progress("finding the safe constant feeds", share); });
    return prepared;
}

std::vector<BenchRun> run_bench(const BenchSettings& settings, const BenchProgress& progress) {
    const std::uint32_t crc = crc_of(program_crc(), settings_text(settings.rules, ""));
    Journal journal(settings.out / "runs.csv", crc);
    run_jobs(settings, jobs_left(settings, journal), journal, progress);
    journal.sort_file();
    std::vector<BenchRun> runs = journal.runs();
    std::erase_if(runs, [&](const BenchRun& run) { return !is_asked_for(run, settings); });
    return runs;
}

}  // namespace millforce::sim
