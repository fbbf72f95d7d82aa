#include "findings.hpp"

#include "rates.hpp"

#include "quorient/diagnosis/words.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace quorient::diagnosis {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A contradiction that begins no earlier than so long before a fault belongs to the fault.
constexpr double belongs_s = 2.0;

/// Two instruments disagree where it lasts, or where it is beyond doubt; what is below passes as a transient.
constexpr double lasting_s = 1.0;
constexpr double least_certainty = 1.3;

/// A value beyond this share of the range is the range's end; both signs may end a little differently.
constexpr double at_range = 0.97;

constexpr std::size_t most_transients = 50;

Kind kind_of(Diagnosis diagnosis)
{
    switch (diagnosis) {
        case Diagnosis::gain: return Kind::gain;
        case Diagnosis::sign: return Kind::sign;
        case Diagnosis::delay: return Kind::delay;
        case Diagnosis::stuck: return Kind::stuck;
        case Diagnosis::zero: return Kind::zero;
        case Diagnosis::saturated: return Kind::saturated;
        case Diagnosis::noise:
        case Diagnosis::erratic: return Kind::noise;
        case Diagnosis::spikes: return Kind::spikes;
        case Diagnosis::mounting: return Kind::mounting;
        case Diagnosis::outside_class: return Kind::outside_class;
        case Diagnosis::absent: return Kind::missing;
        case Diagnosis::bias:
        case Diagnosis::none: break;
    }
    return Kind::bias;
}

/// From rad and rad/s to the units of a report.
double factor_of(Kind kind)
{
    switch (kind) {
        case Kind::bias:
        case Kind::spikes:
        case Kind::mounting:
        case Kind::outside_class: return 1 / degree;
        default: return 1;
    }
}

bool concerns_all_axes(Kind kind)
{
    return kind == Kind::delay || kind == Kind::mounting;
}

Finding finding_of(const fdi::AxisDiagnosis& diagnosis, std::size_t instrument, std::size_t axis)
{
    Finding finding;
    finding.instrument = instrument;
    finding.axis = axis;
    finding.kind = kind_of(diagnosis.kind);
    const bool sized = finding.kind != Kind::stuck && finding.kind != Kind::zero && diagnosis.kind != Diagnosis::erratic &&
                       diagnosis.kind != Diagnosis::none;
    finding.size = sized ? diagnosis.size * factor_of(finding.kind) : unknown;
    finding.uncertainty = sized && diagnosis.sigma > 0 ? diagnosis.sigma * factor_of(finding.kind) : unknown;
    const bool bias_besides = finding.kind == Kind::gain || finding.kind == Kind::sign || finding.kind == Kind::delay;
    if (bias_besides && std::isfinite(diagnosis.bias_sigma)) finding.bias_deg_s = diagnosis.bias / degree;
    return finding;
}

/// How much of a rate of 100 deg/s an error makes wrong: the order of findings.
double weight_of(const Finding& finding)
{
    constexpr double certain = 1e6;
    const double rank = finding.certainty == Certainty::isolated ? certain : finding.certainty == Certainty::detected ? certain / 1e3 : 0;
    const double besides = std::abs(finding.bias_deg_s.value_or(0));
    if (!std::isfinite(finding.size)) return rank + (finding.kind == Kind::bias ? 1 : 100);
    switch (finding.kind) {
        case Kind::gain: return rank + 100 * std::abs(finding.size - 1) + besides;
        case Kind::bias:
        case Kind::outside_class: return rank + std::abs(finding.size);
        case Kind::spikes: return rank + 1;
        case Kind::delay: return rank + 10;  // a lag of the fit stands beside a wrong gain, not before it
        default: return rank + 100;
    }
}

/// One finding for each axis with a diagnosis; of faults of a whole instrument one for all axes.
std::vector<Finding> axis_findings(const std::array<fdi::AxisDiagnosis, 3>& axes, std::size_t instrument)
{
    std::vector<Finding> found;
    for (std::size_t i = 0; i < 3; ++i) {
        if (axes[i].kind == Diagnosis::none) continue;
        Finding finding = finding_of(axes[i], instrument, i);
        if (concerns_all_axes(finding.kind)) {
            finding.axis.reset();
            const auto same = std::find_if(found.begin(), found.end(), [&](const Finding& f) { return f.kind == finding.kind; });
            if (same != found.end()) {
                if (finding.uncertainty < same->uncertainty) *same = finding;
                continue;
            }
        }
        found.push_back(std::move(finding));
    }
    if (found.empty()) {
        Finding finding = finding_of({}, instrument, 0);
        finding.axis.reset();
        found.push_back(finding);
    }
    return found;
}

const Snapshot& last_snapshot(const Isolation& isolation, std::optional<double> until_s)
{
    const Snapshot* last = &isolation.newest;
    if (!until_s) return *last;
    for (const Snapshot& snapshot : isolation.snapshots.items())
        if (snapshot.time_s <= *until_s || last == &isolation.newest) last = &snapshot;
    return *last;
}

std::vector<InstrumentIndex> all_of(std::size_t count)
{
    std::vector<InstrumentIndex> all;
    for (std::size_t m = 0; m < count; ++m) all.push_back(m);
    return all;
}

class Collector {
public:
    explicit Collector(const Evidence& evidence) : evidence_(evidence) {}

    std::vector<Finding> collect()
    {
        found_ = findings_of_setup(evidence_.overview, evidence_.mountings);
        for (std::size_t place = 0; place < evidence_.watch.isolations().size(); ++place) add_isolation(place);
        add_own_evidence();
        std::size_t transients = 0;
        for (const Spell& spell : evidence_.watch.spells()) add_spell(spell, transients);
        std::stable_sort(found_.begin(), found_.end(), [](const Finding& a, const Finding& b) { return weight_of(a) > weight_of(b); });
        return found_;
    }

private:
    void add_isolation(std::size_t place)
    {
        const Isolation& isolation = evidence_.watch.isolations()[place];
        const auto ended_s = evidence_.aftermath.ended(place);
        for (Finding& finding : axis_findings(last_snapshot(isolation, ended_s).axis, isolation.instrument)) {
            finding.certainty = Certainty::isolated;
            finding.from_s = isolation.from_s;
            finding.to_s = ended_s;
            if (finding.bias_deg_s) finding.bias_deg_s = bias_at_rest(finding).value_or(*finding.bias_deg_s);
            found_.push_back(std::move(finding));
        }
    }

    /// Where there is a rest within the fault: what the axis reads there beyond the others' mean.
    std::optional<double> bias_at_rest(const Finding& finding) const
    {
        const auto rest = evidence_.overview.longest_rest();
        if (!rest || rest->from_s < finding.from_s - 1e-6 || rest->to_s > finding.to_s.value_or(1e300) || !finding.axis) return std::nullopt;
        const auto bias_in_common = [&](std::size_t m) {
            return Eigen::Vector3d(evidence_.mountings.of[m].turned * *evidence_.overview.rest_bias(m));
        };
        Eigen::Vector3d others = Eigen::Vector3d::Zero();
        double used = 0;
        for (std::size_t m = 0; m < evidence_.instruments.size(); ++m) {
            if (m == *finding.instrument || !evidence_.overview.rest_bias(m) || is_isolated(m)) continue;
            others += bias_in_common(m);
            used += 1;
        }
        if (used == 0 || !evidence_.overview.rest_bias(*finding.instrument)) return std::nullopt;
        const Eigen::Vector3d beyond =
            evidence_.mountings.of[*finding.instrument].turned.transpose() * (bias_in_common(*finding.instrument) - others / used);
        return beyond(static_cast<Eigen::Index>(*finding.axis)) / degree;
    }

    bool is_isolated(std::size_t m) const
    {
        return std::any_of(evidence_.watch.isolations().begin(), evidence_.watch.isolations().end(),
                           [&](const Isolation& i) { return i.instrument == m; });
    }

    /// What the detector has not named already.
    void add_own_evidence()
    {
        const auto known = [&](std::size_t instrument, double from_s) {
            return std::any_of(evidence_.watch.isolations().begin(), evidence_.watch.isolations().end(), [&](const Isolation& isolation) {
                return isolation.instrument == instrument && isolation.from_s <= from_s + belongs_s;
            });
        };
        for (const StuckSpell& spell : evidence_.aftermath.own_evidence().stuck()) {
            if (known(spell.instrument, spell.from_s) || is_at_range(spell)) continue;
            Finding finding;
            finding.kind = spell.value == 0 ? Kind::zero : Kind::stuck;
            finding.from_s = spell.from_s;
            finding.to_s = spell.to_s;
            add_certain(finding, spell.instrument, spell.axis);
        }
        for (const SpikeTrain& train : evidence_.aftermath.own_evidence().spikes()) {
            if (known(train.instrument, train.from_s) || completed(train)) continue;
            Finding finding;
            finding.kind = Kind::spikes;
            finding.size = train.mean_rad_s / degree;
            finding.from_s = train.from_s;
            finding.to_s = train.to_s;
            finding.remark = counted(train.count, "single sample");
            if (evidence_.instruments.size() > 2) {
                add_certain(finding, train.instrument, train.axis);
                continue;
            }
            finding.candidates = all_of(evidence_.instruments.size());
            found_.push_back(std::move(finding));
        }
    }

    bool is_at_range(const StuckSpell& spell) const
    {
        const auto& reached = evidence_.instruments[spell.instrument].figures.range_reached[spell.axis];
        return reached && std::abs(spell.value) > at_range * reached->range_rad_s;
    }

    /// The detector names spikes when they have come again and again; the train knows the first one and their size.
    bool completed(const SpikeTrain& train)
    {
        const auto same = std::find_if(found_.begin(), found_.end(), [&](const Finding& finding) {
            return finding.kind == Kind::spikes && finding.instrument == train.instrument && finding.axis == train.axis;
        });
        if (same == found_.end()) return false;
        same->from_s = std::min(same->from_s, train.from_s);
        same->size = train.mean_rad_s / degree;
        same->uncertainty = unknown;
        same->remark = counted(train.count, "single sample");
        return true;
    }

    void add_certain(Finding finding, std::size_t instrument, std::size_t axis)
    {
        finding.instrument = instrument;
        finding.axis = axis;
        finding.certainty = Certainty::isolated;
        found_.push_back(std::move(finding));
    }

    bool belongs_to_a_fault(const Spell& spell) const
    {
        return std::any_of(evidence_.watch.isolations().begin(), evidence_.watch.isolations().end(), [&](const Isolation& isolation) {
            return (spell.axes & (AxisMask{7} << (3 * isolation.instrument))) != 0 && spell.to_s >= isolation.from_s - belongs_s;
        });
    }

    void add_spell(const Spell& spell, std::size_t& transients)
    {
        if (spell.what == Spell::What::contradicted && belongs_to_a_fault(spell)) return;
        Finding finding;
        for (std::size_t m = 0; m < evidence_.instruments.size(); ++m)
            if ((spell.axes & (AxisMask{7} << (3 * m))) != 0) finding.candidates.push_back(m);
        if (spell.what == Spell::What::disagreement && explained(finding.candidates, spell)) return;
        if (finding.candidates.size() == 1) {
            finding = contradiction(spell, finding.candidates.front());
        } else {
            finding.kind = spell.what == Spell::What::saturated ? Kind::saturated : Kind::bias;
            finding.size = finding.uncertainty = unknown;
        }
        finding.from_s = spell.from_s;
        finding.to_s = spell.to_s;
        const bool to_the_end = spell.to_s > evidence_.overview.last_s() - lasting_s;
        if (to_the_end) finding.to_s.reset();
        const bool lasts = spell.to_s - spell.from_s > lasting_s && spell.certainty > least_certainty;
        const bool counts = spell.what == Spell::What::saturated || (spell.what == Spell::What::disagreement && lasts);
        finding.certainty = counts ? Certainty::detected : Certainty::transient;
        if (finding.certainty == Certainty::transient && (++transients > most_transients || spell.certainty < 1)) return;
        found_.push_back(std::move(finding));
    }

    /// One of those that disagree is known to be faulty.
    bool explained(const std::vector<InstrumentIndex>& candidates, const Spell& spell) const
    {
        return std::any_of(found_.begin(), found_.end(), [&](const Finding& finding) {
            const bool among = finding.instrument && std::find(candidates.begin(), candidates.end(), *finding.instrument) != candidates.end();
            return among && finding.certainty == Certainty::isolated && finding.from_s <= spell.from_s + belongs_s &&
                   finding.to_s.value_or(1e300) >= spell.from_s;
        });
    }

    static Finding contradiction(const Spell& spell, std::size_t instrument)
    {
        std::array<fdi::AxisDiagnosis, 3> axes;
        for (std::size_t i = 0; i < 3; ++i) axes[i] = spell.diagnosis[3 * instrument + i];
        auto found = axis_findings(axes, instrument);
        return *std::max_element(found.begin(), found.end(), [](const Finding& a, const Finding& b) { return weight_of(a) < weight_of(b); });
    }

    const Evidence& evidence_;
    std::vector<Finding> found_;
};

}  // namespace

std::vector<Finding> findings_of(const Evidence& evidence)
{
    return Collector(evidence).collect();
}

std::vector<Finding> findings_of_times(const std::vector<recording::SurveyedInstrument>& instruments)
{
    std::vector<Finding> found;
    for (std::size_t m = 0; m < instruments.size(); ++m) {
        if (instruments[m].figures.steps_back == 0) continue;
        Finding finding;
        finding.instrument = m;
        finding.kind = Kind::time;
        finding.to_s = instruments[m].figures.duration_s();
        finding.remark = fmt::format("{} times", instruments[m].figures.steps_back);
        finding.candidates = {m};
        found.push_back(std::move(finding));
    }
    if (found.size() == instruments.size()) found.clear();
    return found;
}

std::vector<Finding> findings_of_ranges(const recording::Survey& survey, const std::vector<recording::SurveyedInstrument>& instruments)
{
    std::vector<Finding> found;
    for (std::size_t m = 0; m < instruments.size(); ++m) {
        const std::int64_t first_ns = survey.logs[instruments[m].log].first_ns;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& reached = instruments[m].figures.range_reached[k];
            if (!reached) continue;
            Finding finding;
            finding.instrument = m;
            finding.axis = k;
            finding.kind = Kind::saturated;
            finding.size = finding.uncertainty = unknown;
            finding.from_s = static_cast<double>(reached->first_ns - first_ns) * 1e-9;
            finding.to_s = static_cast<double>(reached->last_ns - first_ns) * 1e-9;
            finding.remark = fmt::format("{} at {:.0f} deg/s", counted(reached->samples, "sample"), reached->range_rad_s / degree);
            finding.candidates = {m};
            found.push_back(std::move(finding));
        }
    }
    return found;
}

std::vector<Finding> findings_of_setup(const Overview& overview, const Mountings& mountings)
{
    std::vector<Finding> found;
    for (std::size_t m = 0; m < mountings.of.size(); ++m) {
        const Mountings::One& one = mountings.of[m];
        if (one.odd) {
            Finding finding;
            finding.kind = Kind::mounting;
            const Eigen::Matrix3d turn = one.turned * one.nominal.transpose();
            finding.size = Eigen::AngleAxisd(turn).angle() / degree;
            finding.uncertainty = unknown;
            finding.remark = "looks like " + words_of_turn(turn);
            finding.certainty = mountings.majority ? Certainty::isolated : Certainty::detected;
            if (mountings.majority) finding.instrument = m;
            else finding.candidates = all_of(mountings.of.size());
            found.push_back(std::move(finding));
        }
        if (one.scale != 1) {
            Finding finding;
            finding.kind = Kind::unit;
            finding.size = one.scale;
            finding.uncertainty = unknown;
            finding.certainty = mountings.unit_majority ? Certainty::isolated : Certainty::detected;
            if (mountings.unit_majority) finding.instrument = m;
            else finding.candidates = all_of(mountings.of.size());
            found.push_back(std::move(finding));
        }
    }
    for (const Absence& absence : overview.absences()) {
        Finding finding;
        finding.instrument = absence.instrument;
        finding.kind = Kind::missing;
        finding.from_s = absence.from_s;
        finding.to_s = absence.to_s;
        finding.size = absence.to_s.value_or(overview.last_s()) - absence.from_s;
        finding.uncertainty = 0;
        finding.certainty = Certainty::isolated;
        found.push_back(std::move(finding));
    }
    return found;
}

}  // namespace quorient::diagnosis
