#include "describe.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/simulation/vessel.hpp"
#include "sources.hpp"

namespace quorient::sensor {

namespace {

class VesselSource final : public FrameSource {
public:
    VesselSource(const system::SensorSettings& settings, std::uint64_t epoch)
        : vessel_(*settings.source.vessel), description_(describe(simulation::channels_of(*settings.source.vessel)))
    {
        description_.epoch = epoch;
        description_.revision = 1;
        description_.unit = settings.process.node.unit;
        copy_text(settings.unit_name, description_.name);
    }

    const ClusterDescription& description() const override { return description_; }

    /// Frames that are not asked for are computed too: the vessel's state needs every interval.
    Advance advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth) override
    {
        for (; next_ <= sequence; ++next_)
            if (!vessel_.next(frame_, state_)) return Advance::end;
        frame = frame_;
        frame.epoch = truth.epoch = description_.epoch;
        frame.unit = truth.unit = description_.unit;
        frame.description_revision = description_.revision;
        truth.sequence = frame.sequence;
        truth.sample_time_ns = frame.sample_time_ns;
        truth.faulty_mask = vessel_.faulty();
        return Advance::frame;
    }

    simulation::FaultInjector& faults() override { return vessel_.faults(); }

private:
    simulation::SimulatedVessel vessel_;
    ClusterDescription description_;
    SensorFrame frame_;
    Eigen::VectorXd state_;
    std::uint64_t next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> make_vessel_source(const system::SensorSettings& settings, std::uint64_t epoch)
{
    return std::make_unique<VesselSource>(settings, epoch);
}

}  // namespace quorient::sensor
