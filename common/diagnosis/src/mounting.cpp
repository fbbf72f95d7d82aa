#include "mounting.hpp"

#include "rates.hpp"

#include "quorient/diagnosis/words.hpp"
#include "quorient/rotation/nearest.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <array>
#include <bit>
#include <cmath>

namespace quorient::diagnosis {
namespace {

/// Below this, a tenth of a second says nothing about how an instrument is mounted.
constexpr double tells_mounting_rad_s = 5 * degree;
constexpr std::size_t least_moving_blocks = 20;
constexpr std::size_t groups = 20;
constexpr double nearly_all = 0.9;  // share of the groups with motion

/// A turn is a turn if it explains the motion (misfit as a share of the motion), and if without it the instruments contradict each other.
constexpr double right_angle_misfit = 0.15;
constexpr double contradiction = 0.4;
constexpr double fitted_misfit = 0.05;
constexpr double least_turn = 12 * degree;
constexpr double second_direction = 0.02;  // share of the motion's strongest: needed for a turn to be seen

/// Numbers in place of rad/s: deg/s, mrad/s, mdeg/s, and the other way round; within so much.
constexpr std::array wrong_units{57.29578, 1000.0, 57295.78, 1 / 57.29578, 1e-3, 1 / 57295.78};
constexpr double unit_tolerance = 0.12;

/// What two instruments say of the same motion.
struct Pair {
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();  // sum of a b'
    double squares_a = 0;
    double squares_b = 0;
    std::size_t blocks = 0;

    /// Sum of |a - R b|^2 as a share of the motion's own squares.
    double misfit(const Eigen::Matrix3d& turn) const
    {
        return std::max(0.0, squares_a + squares_b - 2 * turn.cwiseProduct(products).sum()) / (0.5 * (squares_a + squares_b));
    }
};

using Pairs = std::array<Pair, groups + 1>;  // the last one is of the whole log

struct Relation {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    bool parallel = true;
};

/// All 24 turns that take axes to axes.
const std::vector<Eigen::Matrix3d>& right_angle_turns()
{
    static const std::vector<Eigen::Matrix3d> turns = [] {
        std::vector<Eigen::Matrix3d> found;
        for (unsigned code = 0; code < 6 * 8; ++code) {
            constexpr std::array<std::array<Eigen::Index, 3>, 6> order{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
            Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
            for (unsigned i = 0; i < 3; ++i) turn(static_cast<Eigen::Index>(i), order[code / 8][i]) = (code >> i & 1U) != 0 ? -1 : 1;
            if (turn.determinant() > 0) found.push_back(turn);
        }
        return found;
    }();
    return turns;
}

class Finder {
public:
    Finder(const Overview& overview, const std::vector<recording::SurveyedInstrument>& instruments)
        : overview_(overview), instruments_(instruments)
    {
        result_.of.resize(overview.instruments());
        for (std::size_t m = 0; m < overview.instruments(); ++m) {
            result_.of[m].nominal = nominal_mounting(instruments[m].instrument);
            result_.of[m].turned = result_.of[m].nominal;
        }
    }

    Mountings find()
    {
        find_centres();
        find_units();
        find_turns();
        return result_;
    }

private:
    std::size_t count() const { return overview_.instruments(); }

    /// What is taken out of each instrument: its bias at rest, else its mean (which turns as the motion does).
    void find_centres()
    {
        for (std::size_t m = 0; m < count(); ++m) {
            Eigen::Vector3d sum = Eigen::Vector3d::Zero();
            double blocks = 0;
            for (const Block& block : overview_.blocks()) {
                if ((block.present >> m & 1U) == 0) continue;
                sum += block.rate_rad_s[m].cast<double>();
                blocks += 1;
            }
            centre_.push_back(overview_.rest_bias(m).value_or(blocks > 0 ? Eigen::Vector3d(sum / blocks) : Eigen::Vector3d::Zero()));
        }
    }

    /// Along the body's axes by the log's own statement, in the right unit.
    Eigen::Vector3d rate(const Block& block, std::size_t m) const
    {
        return result_.of[m].nominal * (block.rate_rad_s[m].cast<double>() - centre_[m]) / result_.of[m].scale;
    }

    void find_units()
    {
        std::vector<std::vector<double>> ratios(count());
        for (const Block& block : overview_.blocks()) {
            std::vector<double> norms;
            for (std::size_t m = 0; m < count(); ++m)
                if ((block.present >> m & 1U) != 0) norms.push_back(rate(block, m).norm());
            if (norms.size() < 2) continue;
            const double usual = count() == 2 ? norms.front() : median(norms);
            const double proved = count() == 2 ? *std::max_element(norms.begin(), norms.end()) : usual;
            if (!(usual > 0) || proved < tells_mounting_rad_s) continue;
            for (std::size_t m = 0; m < count(); ++m)
                if ((block.present >> m & 1U) != 0) ratios[m].push_back(rate(block, m).norm() / usual);
        }
        std::size_t right = 0;
        for (std::size_t m = 0; m < count(); ++m) {
            if (ratios[m].size() < least_moving_blocks) continue;
            const double ratio = median(ratios[m]);
            for (const double factor : wrong_units)
                if (std::abs(ratio / factor - 1) < unit_tolerance) result_.of[m].scale = factor;
            right += result_.of[m].scale == 1 ? 1U : 0U;
        }
        result_.unit_majority = 2 * right > count();
    }

    Pairs compare(std::size_t a, std::size_t b) const
    {
        std::vector<const Block*> moving;
        for (const Block& block : overview_.blocks())
            if ((block.present >> a & 1U) != 0 && (block.present >> b & 1U) != 0 && rate(block, a).norm() + rate(block, b).norm() > 2 * tells_mounting_rad_s)
                moving.push_back(&block);
        Pairs pairs;
        for (std::size_t i = 0; i < moving.size(); ++i) {
            const Eigen::Vector3d of_a = rate(*moving[i], a);
            const Eigen::Vector3d of_b = rate(*moving[i], b);
            for (Pair* pair : {&pairs[i * groups / moving.size()], &pairs[groups]}) {
                pair->products += of_a * of_b.transpose();
                pair->squares_a += of_a.squaredNorm();
                pair->squares_b += of_b.squaredNorm();
                ++pair->blocks;
            }
        }
        return pairs;
    }

    static bool holds_nearly_always(const Pairs& pairs, const Eigen::Matrix3d& turn)
    {
        double moving = 0;
        double holds = 0;
        for (std::size_t i = 0; i < groups; ++i) {
            if (pairs[i].blocks == 0) continue;
            moving += 1;
            holds += pairs[i].misfit(turn) < pairs[i].misfit(Eigen::Matrix3d::Identity()) ? 1 : 0;
        }
        return holds >= nearly_all * moving;
    }

    /// How b is turned against a.
    Relation relation(std::size_t a, std::size_t b) const
    {
        const Pairs pairs = compare(a, b);
        const Pair& whole = pairs[groups];
        Relation found;
        if (whole.blocks < least_moving_blocks) return found;
        const double straight = whole.misfit(Eigen::Matrix3d::Identity());
        const Eigen::Matrix3d* best = &right_angle_turns().front();
        for (const Eigen::Matrix3d& turn : right_angle_turns())
            if (whole.misfit(turn) < whole.misfit(*best)) best = &turn;
        const bool separate = instruments_[a].log != instruments_[b].log;
        if (!separate && straight > contradiction && whole.misfit(*best) < right_angle_misfit && holds_nearly_always(pairs, *best))
            return {*best, false};
        const Eigen::Vector3d spread = rotation::singular_values(whole.products);
        if (spread(1) < second_direction * spread(0)) return found;
        const Eigen::Matrix3d fitted = rotation::nearest_rotation(whole.products);
        const bool large = Eigen::AngleAxisd(fitted).angle() > least_turn;
        const bool clear = whole.misfit(fitted) < fitted_misfit && holds_nearly_always(pairs, fitted);
        if (clear && (separate || large)) return {fitted, !large};
        return found;
    }

    void find_turns()
    {
        std::vector<std::vector<Relation>> relations(count(), std::vector<Relation>(count()));
        std::vector<std::size_t> parallels(count(), 1);
        for (std::size_t a = 0; a < count(); ++a)
            for (std::size_t b = a + 1; b < count(); ++b) {
                relations[a][b] = relation(a, b);
                relations[b][a] = {relations[a][b].turn.transpose(), relations[a][b].parallel};
                if (!relations[a][b].parallel) continue;
                ++parallels[a];
                ++parallels[b];
            }
        const auto leader = static_cast<std::size_t>(std::max_element(parallels.begin(), parallels.end()) - parallels.begin());
        result_.majority = 2 * parallels[leader] > count();
        for (std::size_t m = 0; m < count(); ++m) {
            result_.of[m].turned = relations[leader][m].turn * result_.of[m].nominal;
            result_.of[m].odd = !relations[leader][m].parallel && instruments_[m].log == instruments_[leader].log;
        }
    }

    const Overview& overview_;
    const std::vector<recording::SurveyedInstrument>& instruments_;
    Mountings result_;
    std::vector<Eigen::Vector3d> centre_;
};

}  // namespace

Mountings find_mountings(const Overview& overview, const std::vector<recording::SurveyedInstrument>& instruments)
{
    return Finder(overview, instruments).find();
}

Eigen::Matrix3d nominal_mounting(const recording::Instrument& instrument)
{
    Eigen::Matrix3d nominal;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) nominal(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = instrument.axis[i][k];
    return nominal;
}

std::string words_of_turn(const Eigen::Matrix3d& turn)
{
    const Eigen::AngleAxisd turned(turn);
    Eigen::Vector3d axis = turned.axis();
    double angle_deg = turned.angle() / degree;
    Eigen::Index main = 0;
    axis.cwiseAbs().maxCoeff(&main);
    const bool along_axis = std::abs(axis(main)) > std::cos(10 * degree);
    if (axis(main) < 0 && angle_deg < 175) angle_deg = -angle_deg;
    if (along_axis) return fmt::format("{:.0f} degrees about {}", angle_deg, "xyz"[main]);
    if (axis(main) < 0) {
        axis = -axis;
    }
    return fmt::format("{:.0f} degrees about ({:.2f}, {:.2f}, {:.2f})", angle_deg, axis.x(), axis.y(), axis.z());
}

}  // namespace quorient::diagnosis
