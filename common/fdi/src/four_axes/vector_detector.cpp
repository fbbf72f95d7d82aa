#include "four_axes/vector_detector.hpp"

#include "four_axes/polynomial_extrapolation.hpp"

#include <algorithm>
#include <cmath>

namespace quorient::fdi {
namespace {

constexpr double vector_margin = 3;

/// Errors of the one-frame predictions are forgotten with this weight: the last sixteen or so count.
constexpr double newest_weight = 1.0 / 16;

/// Trials over a longer horizon, spread over the history.
constexpr std::size_t most_trials = 8;

/// A window of parities counts as clean up to this many standard deviations of its noise beyond what quantisation can do.
constexpr double clean_sigmas = 3;

/// sum over the triad's axes of |c_j|^2 (sigma_j^2 + q_j^2 / 6), c_j the column of axis j; the largest over the triads.
double triad_variance(const std::array<geometry::Triad, 4>& triads, const Eigen::Vector4d& variance)
{
    double largest = 0;
    for (const auto& triad : triads) {
        double sum = 0;
        for (std::size_t place = 0; place < 3; ++place)
            sum += triad.body_from_axes.col(static_cast<Eigen::Index>(place)).squaredNorm() *
                   variance(static_cast<Eigen::Index>(triad.axis[place]));
        largest = std::max(largest, sum);
    }
    return largest;
}

}  // namespace

tl::expected<std::unique_ptr<VectorDetector>, std::string> VectorDetector::make(const DetectorSettings& settings,
                                                                                  const geometry::SensorCluster& cluster)
{
    const auto made = geometry_of(settings, cluster, "vector");
    if (!made) return tl::unexpected(made.error());
    return std::unique_ptr<VectorDetector>(new VectorDetector(*made, settings.margin.value_or(vector_margin)));
}

VectorDetector::VectorDetector(const Geometry& made, double margin)
    : FourAxisDetector(made), margin_(margin), parity_sigma_(made.parity_sigma), parity_quantum_(made.parity_quantum)
{
    triad_sigma_ = std::sqrt(triad_variance(made.triads, made.variance));
    for (std::size_t i = 0; i < tried_every_frame; ++i)
        extrapolation_weights(polynomials[i].order, 1, std::span(weights_[i]).first(polynomials[i].length));
    forget();
}

void VectorDetector::forget()
{
    size_ = 0;
    next_ = 0;
    cut_ = 0;
    held_ = false;
    parity_running_ = 0;
    prediction_.reset();
    error_.fill(-1);  // not tried yet
    one_frame_.fill(Eigen::Vector3d::Zero());
}

Eigen::Vector3d VectorDetector::extrapolate(std::span<const double> weights, std::size_t newest_age) const
{
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[weights.size() - 1 - i] * past(newest_age + i);
    return sum;
}

void VectorDetector::learn(const Frame& frame)
{
    for (std::size_t i = 0; i < tried_every_frame; ++i) {
        if (size_ < polynomials[i].length) continue;
        const double squared = (one_frame_[i] - frame.body).squaredNorm();
        error_[i] = error_[i] < 0 ? squared : error_[i] + newest_weight * (squared - error_[i]);
    }
    body_[next_] = frame.body;
    parity_running_ += frame.parity;
    parity_total_[next_] = parity_running_;
    next_ = (next_ + 1) % history_length;
    size_ = std::min(size_ + 1, history_length);
    for (std::size_t i = 0; i < tried_every_frame; ++i)
        if (size_ >= polynomials[i].length) one_frame_[i] = extrapolate(std::span(weights_[i]).first(polynomials[i].length), 0);
}

void VectorDetector::observe(const Frame& frame)
{
    prediction_ = held_ ? predict_from_cut(frame.horizon) : predict_one_frame();
    compare(frame);
}

void VectorDetector::compare(const Frame& frame)
{
    if (!prediction_) return;
    working_triad_ = 0;
    for (std::size_t k = 0; k < axis_count; ++k) {
        distance_[k] = (frame.triad_body[k] - prediction_->body).norm();
        if (distance_[k] < distance_[working_triad_]) working_triad_ = k;
    }
}

std::optional<VectorDetector::Prediction> VectorDetector::predict_one_frame() const
{
    if (size_ < warm_up_frames) return std::nullopt;
    std::size_t best = 0;
    for (std::size_t i = 1; i < tried_every_frame; ++i)
        if (error_[i] >= 0 && error_[i] < error_[best]) best = i;
    return Prediction{.body = one_frame_[best], .sigma = std::sqrt(error_[best]), .order = static_cast<unsigned>(polynomials[best].order)};
}

std::optional<VectorDetector::Prediction> VectorDetector::predict_from_cut(unsigned horizon) const
{
    std::optional<Prediction> best;
    for (const Polynomial& polynomial : polynomials) {
        const auto prediction = predict(polynomial, cut_ + horizon);
        if (prediction && (!best || prediction->sigma < best->sigma)) best = prediction;
    }
    return best;
}

std::optional<VectorDetector::Prediction> VectorDetector::predict(const Polynomial& polynomial, std::size_t horizon) const
{
    const std::size_t clean = size_ - cut_;
    if (polynomial.length + horizon > clean) return std::nullopt;
    const std::size_t spare = clean - polynomial.length - horizon;
    const std::size_t stride = std::max<std::size_t>(1, std::min(horizon, spare / most_trials));
    const std::size_t trials = std::min(most_trials, spare / stride + 1);

    std::array<double, longest> buffer;
    const std::span weights = std::span(buffer).first(polynomial.length);
    extrapolation_weights(polynomial.order, static_cast<double>(horizon), weights);
    double squared = 0;
    for (std::size_t trial = 0; trial < trials; ++trial) {
        const std::size_t known = cut_ + trial * stride;
        squared += (extrapolate(weights, known + horizon) - past(known)).squaredNorm();
    }
    // The best of many candidates over few trials flatters itself: half a trial is given away.
    return Prediction{.body = extrapolate(weights, cut_),
                      .sigma = std::sqrt(squared / (static_cast<double>(trials) - 0.5)),
                      .order = static_cast<unsigned>(polynomial.order)};
}

double VectorDetector::parity_sum(std::size_t from_age, std::size_t frames) const
{
    const auto total = [&](std::size_t age) { return parity_total_[(next_ + history_length - 1 - age) % history_length]; };
    return total(from_age) - total(from_age + frames);
}

std::size_t VectorDetector::contaminated_frames() const
{
    constexpr std::array<std::size_t, 20> cuts{0, 2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 160, 192, 256, 320, 400, 500, 640};
    constexpr std::array<std::size_t, 6> windows{4, 8, 16, 32, 64, 128};
    for (const std::size_t cut : cuts) {
        const auto clean = [&](std::size_t window) {
            const double regular = parity_quantum_ + clean_sigmas * parity_sigma_ * std::sqrt(static_cast<double>(window));
            return cut + window >= size_ || std::abs(parity_sum(cut, window)) <= regular;
        };
        if (std::all_of(windows.begin(), windows.end(), clean)) return cut < size_ ? cut : 0;
    }
    return 0;  // the parity was never clean: its offset is the instrument's, not the fault's
}

void VectorDetector::attribute(const Frame& frame, Assessment& assessment)
{
    if (!held_) {
        held_ = true;
        cut_ = contaminated_frames();
        refutation_.fill(0);
        prediction_ = predict_from_cut(frame.horizon);
        compare(frame);
    }
    const std::uint64_t contaminated = cut_ + frame.horizon - 1;
    assessment.onset = frame.identity.sequence - std::min(contaminated, frame.identity.sequence);
    if (prediction_) {
        const double sigma = std::hypot(prediction_->sigma, triad_sigma_);
        for (std::size_t k = 0; k < axis_count; ++k) refutation_[k] = std::max(refutation_[k], distance_[k] / sigma);
    }
    name_unrefuted(assessment);
}

void VectorDetector::name_unrefuted(Assessment& assessment) const
{
    const auto best = static_cast<std::size_t>(std::min_element(refutation_.begin(), refutation_.end()) - refutation_.begin());
    const double refuted = std::max(refutation_[best] + margin_, 2 * refutation_[best]);
    assessment.add_candidate(left_out_by(best));
    for (std::size_t k = 0; k < axis_count; ++k)
        if (k != best && refutation_[k] <= refuted) assessment.add_candidate(left_out_by(k));
    assessment.outcome = assessment.candidate_count == 1 ? Outcome::isolated : Outcome::ambiguous;
    if (assessment.outcome == Outcome::isolated) assessment.isolated = left_out_by(best);
}

std::vector<Detail> VectorDetector::details(const Assessment&) const
{
    if (!prediction_) return {{"predicted", {}}, {"triad_distance", {}}, {"working_triad", {}}, {"order", {}}};
    const Eigen::Vector3d& body = prediction_->body;
    return {{"predicted", std::vector<double>(body.data(), body.data() + 3)},
            {"triad_distance", std::vector<double>(distance_.begin(), distance_.end())},
            {"working_triad", Detail::Axes{triad(working_triad_).mask()}},
            {"order", std::int64_t{prediction_->order}}};
}

}  // namespace quorient::fdi
