#include "quorient/calibration/consensus.hpp"

#include "quorient/geometry/triads.hpp"
#include "quorient/rotation/nearest.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace quorient::calibration {
namespace {

using Kind = OutsideClass::Kind;

/// A gain that is off by more is outside every class. Sound instruments differ by up to 3 %, boxes on a frame that flexes by up to 8 %.
constexpr double largest_gain_error = 0.10;

constexpr double sigmas = 3;              // that an estimate must lie beyond its limit
constexpr double huber_sigmas = 1.5;      // a residual beyond them pulls no harder
constexpr int reweightings = 8;
constexpr double sigma_of_median = 1.4826;  // makes a standard deviation of normal residuals' median magnitude
constexpr double colour = 4;              // so many averaged samples are one independent piece of information
constexpr double least_motion_to_residual = 5;  // the weakest motion: less shows no gains
constexpr double least_gain = 0.1;        // below it an axis has no direction
constexpr std::size_t fewest_samples = 20;

/// What one instrument's axes make of another's rates.
struct PairFit {
    std::vector<Eigen::Vector3d> direction;  ///< g, per axis of the instrument
    std::vector<double> gain_sigma;
    std::vector<double> bias;
    std::vector<double> bias_sigma;
    double residual = 0;  ///< largest of the axes [rad/s]
    bool seen = false;    ///< the motion shows gains
};

/// An instrument's axes among all of the cluster's, and its body rates.
struct Instrument {
    std::vector<Eigen::Index> axes;
    Eigen::MatrixX4d rates;  ///< a row per sample: w, 1
    double weakest_motion = 0;
};

std::vector<Instrument> instruments_of(const Eigen::MatrixXd& measured, const geometry::SensorCluster& cluster)
{
    std::vector<Instrument> instruments(cluster.instrument_name.size());
    for (std::size_t axis = 0; axis < cluster.size(); ++axis)
        instruments[cluster.instrument[axis]].axes.push_back(static_cast<Eigen::Index>(axis));
    for (Instrument& instrument : instruments) {
        const auto body_from_axes = geometry::least_squares_inverse(cluster.axes(instrument.axes, Eigen::all));
        if (!body_from_axes) return {};
        instrument.rates.setOnes(measured.rows(), 4);
        instrument.rates.leftCols<3>() = measured(Eigen::all, instrument.axes) * body_from_axes->transpose();
        const Eigen::MatrixX3d moving = instrument.rates.leftCols<3>().rowwise() - instrument.rates.leftCols<3>().colwise().mean();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(moving.transpose() * moving / static_cast<double>(measured.rows()));
        instrument.weakest_motion = std::sqrt(std::max(0.0, spread.eigenvalues()(0)));
    }
    return instruments;
}

double median_magnitude(Eigen::VectorXd values)
{
    const Eigen::Index middle = values.size() / 2;
    values = values.cwiseAbs().eval();
    std::nth_element(values.begin(), values.begin() + middle, values.end());
    return values(middle);
}

Eigen::Matrix4d pseudo_inverse(const Eigen::Matrix4d& normal)
{
    return Eigen::JacobiSVD<Eigen::Matrix4d, Eigen::NoQRPreconditioner>(normal, Eigen::ComputeFullU | Eigen::ComputeFullV)
        .solve(Eigen::Matrix4d::Identity());
}

/// One axis by Huber's M-estimate; its figures go into the fit.
void fit_axis(const Eigen::MatrixX4d& rates, const Eigen::VectorXd& measured, PairFit& fit)
{
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(measured.size());
    Eigen::Vector4d found;
    Eigen::Matrix4d covariance;
    double deviation = 0;
    for (int round = 0; round < reweightings; ++round) {
        const Eigen::Matrix4d normal = rates.transpose() * weight.asDiagonal() * rates;
        covariance = pseudo_inverse(normal);
        found = covariance * (rates.transpose() * (weight.asDiagonal() * measured));
        const Eigen::VectorXd residual = measured - rates * found;
        deviation = std::max(1e-12, sigma_of_median * median_magnitude(residual));
        weight = (huber_sigmas * deviation / residual.cwiseAbs().array().max(huber_sigmas * deviation)).matrix();
    }
    const Eigen::Vector3d direction = found.head<3>();
    const Eigen::Vector3d unit = direction.norm() > 0 ? Eigen::Vector3d(direction.normalized()) : Eigen::Vector3d::UnitX();
    const double scale = colour * deviation * deviation;
    fit.direction.push_back(direction);
    fit.gain_sigma.push_back(std::sqrt(scale * std::max(0.0, unit.dot(covariance.topLeftCorner<3, 3>() * unit))));
    fit.bias.push_back(found(3));
    fit.bias_sigma.push_back(std::sqrt(scale * std::max(0.0, covariance(3, 3))));
    fit.residual = std::max(fit.residual, deviation);
}

PairFit fit_pair(const Eigen::MatrixXd& measured, const Instrument& of, const Instrument& against)
{
    PairFit fit;
    for (const Eigen::Index axis : of.axes) fit_axis(against.rates, measured.col(axis), fit);
    fit.seen = against.weakest_motion > least_motion_to_residual * fit.residual;
    return fit;
}

/// The rotation from the instrument's frame to the other one's: Wahba's problem over the directions of its axes.
Eigen::Matrix3d rotation_of(const PairFit& fit, const Eigen::MatrixX3d& nominal)
{
    Eigen::Matrix3d profile = Eigen::Matrix3d::Zero();
    for (Eigen::Index a = 0; a < nominal.rows(); ++a) {
        const Eigen::Vector3d& direction = fit.direction[static_cast<std::size_t>(a)];
        if (direction.norm() > least_gain) profile += direction.normalized() * nominal.row(a);
    }
    return rotation::nearest_rotation(profile);
}

bool is_reflected(const PairFit& fit, const Eigen::MatrixX3d& nominal)
{
    if (nominal.rows() != 3) return false;
    Eigen::Matrix3d seen;
    for (Eigen::Index a = 0; a < 3; ++a) seen.row(a) = fit.direction[static_cast<std::size_t>(a)].transpose();
    return seen.determinant() * Eigen::Matrix3d(nominal).determinant() < 0;
}

bool gain_is_outside(const PairFit& fit, std::size_t a)
{
    return fit.seen && std::abs(fit.direction[a].norm() - 1) > largest_gain_error + sigmas * fit.gain_sigma[a];
}

bool bias_is_outside(const PairFit& fit, std::size_t a, const fdi::ClassFigures& figures)
{
    return std::abs(fit.bias[a]) > figures.largest_bias_rad_s + sigmas * fit.bias_sigma[a];
}

/// The array, compared pair by pair.
class Pairs {
public:
    Pairs(const Eigen::MatrixXd& measured, const std::vector<Instrument>& instruments, const geometry::SensorCluster& cluster,
          const fdi::ClassFigures& figures)
        : instruments_(instruments), cluster_(cluster), figures_(figures)
    {
        for (const Instrument& of : instruments)
            for (const Instrument& against : instruments) fits_.push_back(fit_pair(measured, of, against));
    }

    const PairFit& fit(std::size_t of, std::size_t against) const { return fits_[of * instruments_.size() + against]; }
    Eigen::MatrixX3d nominal(std::size_t m) const { return cluster_.axes(instruments_[m].axes, Eigen::all); }

    bool agree(std::size_t i, std::size_t j) const { return within_class(i, j) && within_class(j, i); }

    /// The largest set of instruments that one of them agrees with, that one first.
    std::vector<std::size_t> sound() const
    {
        std::vector<std::size_t> largest;
        for (std::size_t centre = 0; centre < instruments_.size(); ++centre) {
            std::vector<std::size_t> members{centre};
            for (std::size_t m = 0; m < instruments_.size(); ++m)
                if (m != centre && agree(centre, m)) members.push_back(m);
            if (members.size() > largest.size()) largest = members;
        }
        return largest;
    }

    /// The axes of this instrument that the sound ones contradict.
    std::vector<OutsideClass> outside(std::size_t m, const std::vector<std::size_t>& sound) const
    {
        std::vector<OutsideClass> found;
        const PairFit& centre = fit(m, sound.front());
        const std::optional<std::size_t> reversed = reversed_axis(m, centre);
        for (std::size_t a = 0; a < instruments_[m].axes.size(); ++a) {
            OutsideClass axis{.axis = static_cast<std::size_t>(instruments_[m].axes[a])};
            axis.gain_sigma = centre.gain_sigma[a];
            axis.bias_sigma_rad_s = centre.bias_sigma[a];
            axis.gain = 0;
            for (const std::size_t j : sound) {
                axis.gain += fit(m, j).direction[a].norm() / static_cast<double>(sound.size());
                axis.bias_rad_s += fit(m, j).bias[a] / static_cast<double>(sound.size());
            }
            if (reversed == a) axis.gain = -axis.gain;
            if (reversed == a) axis.kind = Kind::sign;
            else if (gain_is_outside(centre, a)) axis.kind = Kind::gain;
            else if (bias_is_outside(centre, a, figures_)) axis.kind = Kind::bias;
            else continue;
            found.push_back(axis);
        }
        return found;
    }

private:
    bool within_class(std::size_t of, std::size_t against) const
    {
        const PairFit& pair = fit(of, against);
        for (std::size_t a = 0; a < pair.bias.size(); ++a)
            if (gain_is_outside(pair, a) || bias_is_outside(pair, a, figures_)) return false;
        return !(pair.seen && is_reflected(pair, nominal(of)));
    }

    /// Which axis has to be turned back for the smallest rotation from the nominal mounting.
    std::optional<std::size_t> reversed_axis(std::size_t m, const PairFit& pair) const
    {
        if (!pair.seen || !is_reflected(pair, nominal(m))) return std::nullopt;
        std::optional<std::size_t> best;
        double smallest = 0;
        for (std::size_t a = 0; a < pair.direction.size(); ++a) {
            PairFit turned = pair;
            turned.direction[a] *= -1;
            const double angle = Eigen::AngleAxisd(rotation_of(turned, nominal(m))).angle();
            if (best && angle >= smallest) continue;
            best = a;
            smallest = angle;
        }
        return best;
    }

    const std::vector<Instrument>& instruments_;
    const geometry::SensorCluster& cluster_;
    const fdi::ClassFigures& figures_;
    std::vector<PairFit> fits_;
};

}  // namespace

Consensus consensus_of(const std::vector<geometry::AxisVector>& rates, const geometry::SensorCluster& cluster, const fdi::ClassFigures& figures)
{
    Consensus result;
    if (rates.size() < fewest_samples || cluster.instrument_name.size() < 2) return result;
    Eigen::MatrixXd measured(static_cast<Eigen::Index>(rates.size()), static_cast<Eigen::Index>(cluster.size()));
    for (std::size_t i = 0; i < rates.size(); ++i) measured.row(static_cast<Eigen::Index>(i)) = rates[i].transpose();
    const auto instruments = instruments_of(measured, cluster);
    if (instruments.empty()) return result;

    const Pairs pairs(measured, instruments, cluster, figures);
    const auto sound = pairs.sound();
    if (sound.size() == instruments.size()) return result;
    if (2 * sound.size() <= instruments.size()) {
        result.ambiguous = "the instruments disagree beyond what their class allows, and no majority agrees";
        return result;
    }
    for (std::size_t m = 0; m < instruments.size(); ++m) {
        if (std::ranges::find(sound, m) != sound.end()) continue;
        for (const OutsideClass& axis : pairs.outside(m, sound)) {
            result.outside.push_back(axis);
            result.outside_mask |= axis_bit(axis.axis);
        }
    }
    if (result.outside.empty()) return result;  // at the border of the class: seen from the sound instruments, every axis is inside
    std::ranges::sort(result.outside, {}, &OutsideClass::axis);
    const std::size_t centre = sound.front();
    const Eigen::Matrix3d first_from_centre = rotation_of(pairs.fit(0, centre), pairs.nominal(0)).transpose();
    for (std::size_t m = 0; m < instruments.size(); ++m)
        result.to_first.emplace_back(first_from_centre * rotation_of(pairs.fit(m, centre), pairs.nominal(m)));
    return result;
}

}  // namespace quorient::calibration
