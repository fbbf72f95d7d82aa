#include "describe.hpp"
#include "quorient/messages/meaning.hpp"
#include "quorient/messages/name.hpp"
#include "sources.hpp"

namespace quorient::sensor {

namespace {

class SimulationSource final : public FrameSource {
public:
    SimulationSource(const system::SensorSettings& settings, std::uint64_t epoch)
        : instrument_(settings.source.scenario, *settings.cluster, settings.process.node.unit, settings.kind, epoch),
          description_(describe(*settings.cluster))
    {
        description_.epoch = epoch;
        description_.revision = 1;
        description_.unit = settings.process.node.unit;
        description_.initial_attitude = settings.initial_attitude.value_or(instrument_.initial_attitude());
        description_.initial_attitude_known = octet(InitialAttitude::stated);
        copy_text(settings.unit_name, description_.name);
    }

    const ClusterDescription& description() const override { return description_; }

    Advance advance_to(std::uint64_t sequence, SensorFrame& frame, TruthState& truth) override
    {
        if (sequence >= instrument_.frame_count()) return Advance::end;
        instrument_.advance_to(sequence, frame, truth);
        frame.description_revision = description_.revision;
        return Advance::frame;
    }

    simulation::FaultInjector& faults() override { return instrument_.faults(); }

private:
    simulation::SimulatedInstrument instrument_;
    ClusterDescription description_;
};

}  // namespace

std::unique_ptr<FrameSource> make_simulation_source(const system::SensorSettings& settings, std::uint64_t epoch)
{
    return std::make_unique<SimulationSource>(settings, epoch);
}

}  // namespace quorient::sensor
