#include "monte_carlo.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <mutex>
#include <random>
#include <thread>

namespace quorient::studies {

namespace {

/// The random numbers of one block. Boost's distributions and not the standard library's: theirs are the same everywhere.
class BlockRandom {
public:
    BlockRandom(std::uint64_t seed, std::size_t scene, std::uint64_t block)
    {
        std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U), static_cast<std::uint32_t>(scene),
                               static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32U)};
        engine_.seed(sequence);
    }

    double normal() { return normal_(engine_); }
    double uniform(double least, double most) { return least + (most - least) * unit_(engine_); }
    double sign() { return (engine_() >> 63U) != 0 ? 1 : -1; }
    std::size_t below(std::size_t count) { return boost::random::uniform_int_distribution<std::size_t>(0, count - 1)(engine_); }

private:
    std::mt19937_64 engine_;
    boost::random::normal_distribution<double> normal_;
    boost::random::uniform_01<double> unit_;
};

double draw_size(const Faults& faults, BlockRandom& random)
{
    if (faults.law == Faults::Law::uniform) return random.uniform(faults.least, faults.most);
    double size = std::abs(random.normal());
    while (size < faults.least) size = std::abs(random.normal());
    return size;
}

AxisMask draw_axes(std::size_t count, std::size_t of, BlockRandom& random)
{
    AxisMask axes = 0;
    while (static_cast<std::size_t>(std::popcount(axes)) < count) axes |= axis_bit(random.below(of));
    return axes;
}

struct Measured {
    std::array<double, max_axes> value{};
    AxisMask faulty = 0;
};

/// No motion: every method is blind to it, and so need not be shown any.
void draw(const Scene& scene, BlockRandom& random, Measured& measured)
{
    const std::size_t n = scene.cluster.size();
    for (std::size_t axis = 0; axis < n; ++axis) measured.value[axis] = scene.noisy ? random.normal() : 0;
    measured.faulty = draw_axes(scene.faults.count, n, random);
    double shared = 0;
    if (scene.faults.equal) shared = draw_size(scene.faults, random);
    for (std::size_t axis = 0; axis < n; ++axis)
        if (has_axis(measured.faulty, axis))
            measured.value[axis] += random.sign() * (scene.faults.equal ? shared : draw_size(scene.faults, random));
}

using Judges = std::vector<std::unique_ptr<Judge>>;

void play(const Scene& scene, Judges& judges, BlockRandom random, std::uint64_t trials, std::vector<Tally>& tallies)
{
    Measured measured;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
        draw(scene, random, measured);
        for (std::size_t judge = 0; judge < judges.size(); ++judge)
            tallies[judge].count(judges[judge]->answer({measured.value.data(), scene.cluster.size()}), measured.faulty);
    }
}

/// What all threads share: the next block to play, and where counts go.
class Work {
public:
    Work(const std::vector<Scene>& scenes, const RunSettings& settings, const OnProgress& on_progress)
        : scenes_(scenes),
          settings_(settings),
          on_progress_(on_progress),
          blocks_of_scene_((settings.trials + block_trials - 1) / block_trials),
          blocks_(blocks_of_scene_ * scenes.size())
    {
        for (const Scene& scene : scenes) total_.emplace_back(scene.judges.size());
    }

    void work()
    {
        Judges judges;
        std::size_t scene_of_judges = scenes_.size();
        for (std::size_t next = next_++; next < blocks_; next = next_++) {
            const std::size_t scene = next / blocks_of_scene_;
            const std::uint64_t block = next % blocks_of_scene_;
            if (scene != scene_of_judges) {
                judges.clear();
                for (const JudgeFactory& make : scenes_[scene].judges)
                    judges.push_back(make(scenes_[scene].cluster, scenes_[scene].faults));
                scene_of_judges = scene;
            }
            std::vector<Tally> tallies(judges.size());
            const std::uint64_t trials = std::min(block_trials, settings_.trials - block * block_trials);
            play(scenes_[scene], judges, BlockRandom(settings_.seed, scene, block), trials, tallies);
            add(scene, tallies);
        }
    }

    std::vector<std::vector<Tally>> total() && { return std::move(total_); }

private:
    void add(std::size_t scene, const std::vector<Tally>& tallies)
    {
        const std::lock_guard lock(mutex_);
        for (std::size_t judge = 0; judge < tallies.size(); ++judge) total_[scene][judge] += tallies[judge];
        ++done_;
        if (on_progress_) on_progress_(done_, blocks_);
    }

    const std::vector<Scene>& scenes_;
    const RunSettings& settings_;
    const OnProgress& on_progress_;
    std::uint64_t blocks_of_scene_;
    std::size_t blocks_;
    std::atomic<std::size_t> next_{0};
    std::mutex mutex_;
    std::size_t done_ = 0;
    std::vector<std::vector<Tally>> total_;
};

}  // namespace

void Tally::count(const Answer& answer, AxisMask faulty)
{
    if (!answer.decided) ++flagged;
    else if (answer.named == faulty) ++correct;
    else if (answer.named == 0) ++missed;
    else ++wrong;
}

Tally& Tally::operator+=(const Tally& other)
{
    correct += other.correct;
    wrong += other.wrong;
    missed += other.missed;
    flagged += other.flagged;
    return *this;
}

Rate rate(std::uint64_t count, std::uint64_t trials)
{
    if (trials == 0) return {};
    const double n = static_cast<double>(trials);
    const double share = static_cast<double>(count) / n;
    return {100 * share, 100 * std::sqrt(share * (1 - share) / n)};
}

std::vector<std::vector<Tally>> run(const std::vector<Scene>& scenes, const RunSettings& settings, const OnProgress& on_progress)
{
    Work work(scenes, settings, on_progress);
    const unsigned threads = settings.threads != 0 ? settings.threads : std::max(1U, std::thread::hardware_concurrency());
    {
        std::vector<std::jthread> helpers;
        for (unsigned k = 1; k < threads; ++k) helpers.emplace_back([&work] { work.work(); });
        work.work();
    }
    return std::move(work).total();
}

}  // namespace quorient::studies
