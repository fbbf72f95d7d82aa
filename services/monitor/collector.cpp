#include "collector.hpp"

#include "quorient/messages/meaning.hpp"
#include "quorient/messages/time.hpp"
#include "quorient/rotation/quaternion.hpp"

#include <algorithm>

namespace quorient::monitor {
namespace {

constexpr std::int64_t fresh_ns = 1'000'000'000;

bool is_fresh(std::int64_t arrival_ns, std::int64_t now_ns)
{
    return arrival_ns != 0 && now_ns - arrival_ns <= fresh_ns;
}

}  // namespace

Collector::Collector(const system::System& system) : unit_(system.unit), lanes_(std::min(system.lanes.size(), max_lanes))
{
    for (std::size_t place = 0; place < lanes_; ++place) detector_[place] = system.lanes[place].detector.detector;
    tick_.events.reserve(max_events);
}

void Collector::on_description(const ClusterDescription& description)
{
    if (description.unit != unit_) return;
    tick_.description = description;
    tick_.described = true;
}

void Collector::on_truth(const TruthState& truth)
{
    if (truth.unit != unit_ || truth.attitude_known == 0) return;
    compare({identity_of(truth), truth.attitude, true}, outputs_, truths_);
}

void Collector::on_verdict(const FaultVerdict& verdict, std::int64_t now_ns)
{
    if (verdict.unit != unit_) return;
    const auto place = static_cast<std::size_t>(std::find(detector_.begin(), detector_.begin() + lanes_, verdict.detector) - detector_.begin());
    if (place == lanes_) return;
    auto& lane = tick_.lane[place];
    lane.verdict = verdict;
    lane.isolated |= verdict.isolated_mask;
    lane.provisional |= provisional_mask(verdict);
    lane.suspect |= verdict.suspect_mask;
    ++lane.verdicts;
    for (std::size_t axis = 0; axis < max_axes; ++axis) lane.residual[axis].add(verdict.residual[axis]);
    verdict_ns_[place] = now_ns;
}

void Collector::on_diagnosis(const FaultDiagnosis& diagnosis)
{
    if (diagnosis.unit != unit_) return;
    for (std::size_t place = 0; place < lanes_; ++place) {
        if (detector_[place] == diagnosis.detector) tick_.lane[place].diagnosis = diagnosis;
    }
}

void Collector::on_voted(const VotedAttitude& voted, std::int64_t now_ns)
{
    if (voted.unit != unit_) return;
    tick_.voted = voted;
    voted_ns_ = now_ns;
    ++tick_.voted_frames;
    look_at_latency(voted);
    compare({identity_of(voted), voted.attitude, true}, truths_, outputs_);
}

void Collector::look_at_latency(const VotedAttitude& voted)
{
    const auto sensor_ns = voted.stamp_ns[static_cast<std::size_t>(Hop::sensor)];
    const auto voter_ns = voted.stamp_ns[static_cast<std::size_t>(Hop::voter_out)];
    if (sensor_ns != 0 && voter_ns > sensor_ns) tick_.latencies.add(seconds(voter_ns - sensor_ns));
}

void Collector::compare(const Half& half, Halves& counterparts, Halves& own)
{
    auto& counterpart = counterparts[half.identity.sequence % counterparts.size()];
    if (!counterpart.waits || counterpart.identity != half.identity) {
        own[half.identity.sequence % own.size()] = half;
        return;
    }
    counterpart.waits = false;
    tick_.error_rad = rotation::angle_between(half.attitude, counterpart.attitude);
    tick_.error.add(tick_.error_rad);
}

void Collector::on_event(const HealthEvent& event)
{
    if (event.unit != unit_) return;
    if (tick_.events.size() < max_events) tick_.events.push_back(event);
    else ++tick_.events_lost;
}

void Collector::on_status(const ServiceStatus& status, std::int64_t now_ns)
{
    if (status.unit != unit_) return;
    std::size_t place = 0;
    while (place < tick_.services && tick_.service[place].status.service != status.service) ++place;
    if (place == max_services) return;
    auto& service = tick_.service[place];
    if (place == tick_.services) {
        ++tick_.services;
    } else if (service.status.process != status.process) {
        ++service.restarts;
        service.rate_hz = not_known;
    } else if (status.wall_time_ns > service.status.wall_time_ns) {
        const double elapsed_s = seconds(status.wall_time_ns - service.status.wall_time_ns);
        service.rate_hz = static_cast<double>(status.published - service.status.published) / elapsed_s;
    }
    service.status = status;
    status_ns_[place] = now_ns;
}

const Tick& Collector::tick(std::int64_t now_ns, std::int64_t wall_time_ns)
{
    tick_.wall_time_ns = wall_time_ns;
    tick_.voted_fresh = is_fresh(voted_ns_, now_ns);
    tick_.voted_age_s = voted_ns_ == 0 ? not_known : seconds(now_ns - voted_ns_);
    if (!tick_.voted_fresh) tick_.error_rad = not_known;
    for (std::size_t place = 0; place < lanes_; ++place) tick_.lane[place].fresh = is_fresh(verdict_ns_[place], now_ns);
    for (std::size_t place = 0; place < tick_.services; ++place) tick_.service[place].age_s = seconds(now_ns - status_ns_[place]);
    return tick_;
}

void Collector::begin()
{
    ++tick_.number;
    tick_.voted_frames = 0;
    tick_.error = {};
    tick_.latencies = {};
    tick_.events.clear();
    for (auto& lane : tick_.lane) {
        lane.verdicts = 0;
        lane.isolated = lane.provisional = lane.suspect = 0;
        lane.residual.fill({});
    }
}

}  // namespace quorient::monitor
