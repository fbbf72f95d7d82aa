#include "aftermath.hpp"

#include "rates.hpp"

#include <cmath>

namespace quorient::diagnosis {
namespace {

constexpr double second_s = 1.0;
constexpr double least_frames_in_second = 5;
constexpr double in_motion_rad_s = 5 * degree;
constexpr std::size_t kept_seconds = 4000;

/// So many sound seconds in a row end a fault.
constexpr unsigned sound_seconds = 3;

/// A second tells a fault from none where the one explains the differences so many times better than the other, and they part by more than this.
constexpr double clearly = 4;
constexpr double least_parting_rad_s = 0.3 * degree;

/// The fault is first described so long after it was named.
constexpr double described_after_s = 1.0;

bool tells_its_end(Diagnosis kind)
{
    return kind == Diagnosis::bias || kind == Diagnosis::outside_class || kind == Diagnosis::gain || kind == Diagnosis::sign ||
           kind == Diagnosis::stuck || kind == Diagnosis::zero;
}

double gain_of(const fdi::AxisDiagnosis& diagnosis)
{
    if (diagnosis.kind == Diagnosis::stuck || diagnosis.kind == Diagnosis::zero) return 0;
    return diagnosis.kind == Diagnosis::gain || diagnosis.kind == Diagnosis::sign ? diagnosis.size : 1;
}

const Snapshot& early_snapshot(const Isolation& isolation)
{
    for (const Snapshot& snapshot : isolation.snapshots.items())
        if (snapshot.time_s >= isolation.named_s + described_after_s) return snapshot;
    return isolation.newest;
}

}  // namespace

Aftermath::Aftermath(const Array& array, const std::vector<Isolation>& faulty)
    : array_(array),
      faulty_(faulty),
      sound_((1U << array.instruments()) - 1),
      own_evidence_(array.instruments()),
      flexing_(array.instruments()),
      seconds_(array.instruments()),
      noise_(array.instruments(), Decimated<Eigen::Vector3f>(kept_seconds)),
      ends_(faulty.size())
{
    for (const Isolation& isolation : faulty) sound_ &= ~(1U << isolation.instrument);
    if (sound_ == 0) sound_ = (1U << array.instruments()) - 1;
}

void Aftermath::add(const recording::AlignedFrame& frame)
{
    const double end_s = static_cast<double>(frame.time_ns) * 1e-9;
    const double begin_s = end_s - frame.interval_s;
    if (!begun_) second_begin_s_ = begin_s;
    if (frame.after_gap && begun_) {
        end_second();
        second_begin_s_ = begin_s;
    }
    begun_ = true;
    last_s_ = end_s;
    compare(frame);
    own_evidence_.add(begin_s, end_s, compared_);
    if (!faulty_.empty() && begin_s >= faulty_.front().from_s - 1e-9) integrate(frame);
    if (end_s - second_begin_s_ >= second_s - 1e-6) end_second();
}

void Aftermath::finish()
{
    end_second();
    own_evidence_.finish();
}

void Aftermath::compare(const recording::AlignedFrame& frame)
{
    compared_.clear();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double used = 0;
    for (std::size_t m = 0; m < array_.instruments(); ++m) {
        if ((sound_ >> m & 1U) == 0 || !has_triad(frame, m)) continue;
        sum += array_.common(frame, m);
        used += 1;
    }
    for (std::size_t m = 0; m < array_.instruments(); ++m) {
        if (!has_triad(frame, m)) continue;
        const Eigen::Vector3d own = array_.common(frame, m);
        const bool among = (sound_ >> m & 1U) != 0;
        const double others = used - (among ? 1 : 0);
        if (others < 1) continue;
        const Eigen::Vector3d rate = array_.own_axes(m, among ? Eigen::Vector3d((sum - own) / others) : Eigen::Vector3d(sum / others));
        const Eigen::Vector3d difference = array_.measured(frame, m) - rate;
        compared_.push_back({m, rate_of(frame, m), array_.measured(frame, m), rate});
        if (among) flexing_.add(m, frame.interval_s, array_.measured(frame, m), rate);
        Second& second = seconds_[m];
        second.frames += 1;
        second.difference += difference;
        second.squares += difference.cwiseAbs2();
        second.rate_products += difference.cwiseProduct(rate);
        second.rate += rate;
        second.rate_squares += rate.cwiseAbs2();
    }
}

void Aftermath::end_second()
{
    for (std::size_t m = 0; m < array_.instruments(); ++m) {
        const Second& second = seconds_[m];
        if (second.frames < least_frames_in_second || std::sqrt(second.rate_squares.sum() / second.frames) < in_motion_rad_s) continue;
        const Eigen::Vector3d variance = second.squares / second.frames - (second.difference / second.frames).cwiseAbs2();
        noise_[m].add(variance.cwiseMax(0).cwiseSqrt().cast<float>());
    }
    for (std::size_t place = 0; place < faulty_.size(); ++place)
        if (seconds_[faulty_[place].instrument].frames >= least_frames_in_second) watch_end(place, seconds_[faulty_[place].instrument]);
    for (Second& second : seconds_) second = {};
    second_begin_s_ = last_s_;
}

/// Whether this second's differences are those of the fault, d = bias + (gain - 1) rate, or those from before it.
void Aftermath::watch_end(std::size_t place, const Second& second)
{
    const Isolation& isolation = faulty_[place];
    End& end = ends_[place];
    if (last_s_ <= isolation.from_s) {
        end.baseline_frames += second.frames;
        end.baseline += second.difference;
        return;
    }
    if (second_begin_s_ < isolation.named_s) return;
    const Eigen::Vector3d before = end.baseline_frames > 0 ? Eigen::Vector3d(end.baseline / end.baseline_frames) : Eigen::Vector3d::Zero();
    const Snapshot& described = early_snapshot(isolation);
    double faulty = 0;
    double sound = 0;
    double parting = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const fdi::AxisDiagnosis& axis = described.axis[static_cast<std::size_t>(i)];
        if (!tells_its_end(axis.kind)) continue;
        const double factor = gain_of(axis) - 1;
        const double bias = axis.bias + before(i);
        const double n = second.frames;
        sound += second.squares(i) - 2 * before(i) * second.difference(i) + n * before(i) * before(i);
        faulty += second.squares(i) - 2 * bias * second.difference(i) - 2 * factor * second.rate_products(i) + n * bias * bias +
                  2 * bias * factor * second.rate(i) + factor * factor * second.rate_squares(i);
        parting += axis.bias * axis.bias + 2 * axis.bias * factor * second.rate(i) / n + factor * factor * second.rate_squares(i) / n;
    }
    if (std::sqrt(std::max(0.0, parting)) < least_parting_rad_s) return;
    if (clearly * sound < faulty) {
        if (!end.sound_since_s) end.sound_since_s = second_begin_s_;
        ++end.sound_seconds;
    } else if (faulty < sound) {
        end = {end.baseline_frames, end.baseline, std::nullopt, 0};
    }
}

void Aftermath::integrate(const recording::AlignedFrame& frame)
{
    const std::size_t faulty = faulty_.front().instrument;
    if (!has_triad(frame, faulty)) return;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double used = 0;
    for (std::size_t m = 0; m < array_.instruments(); ++m) {
        if ((sound_ >> m & 1U) == 0 || m == faulty || !has_triad(frame, m)) continue;
        sum += array_.common(frame, m);
        used += 1;
    }
    if (used == 0) return;
    const Eigen::Vector3d own = array_.common(frame, faulty);
    without_ = rotation::renormalised(without_ * rotation::from_rotation_vector(sum / used * frame.interval_s));
    all_ = rotation::renormalised(all_ * rotation::from_rotation_vector((sum + own) / (used + 1) * frame.interval_s));
    alone_ = rotation::renormalised(alone_ * rotation::from_rotation_vector(own * frame.interval_s));
    with_deg_ = rotation::angle_between(all_, without_) / degree;
    alone_deg_ = rotation::angle_between(alone_, without_) / degree;
    if (!attitude_) attitude_ = AttitudeDifference{faulty, 0, 0};
    attitude_->with_deg = std::max(attitude_->with_deg, with_deg_);
    attitude_->alone_deg = std::max(attitude_->alone_deg, alone_deg_);
}

std::optional<Eigen::Vector3d> Aftermath::noise_in_motion(std::size_t m) const
{
    if (noise_[m].items().empty()) return std::nullopt;
    Eigen::Vector3d found;
    for (Eigen::Index i = 0; i < 3; ++i) {
        std::vector<double> values;
        for (const Eigen::Vector3f& second : noise_[m].items()) values.push_back(second(i));
        found(i) = median(values);
    }
    return found;
}

std::optional<double> Aftermath::ended(std::size_t place) const
{
    const End& end = ends_[place];
    return end.sound_seconds >= sound_seconds ? end.sound_since_s : std::nullopt;
}

}  // namespace quorient::diagnosis
