#include "mounting_report.hpp"

#include "quorient/diagnosis/words.hpp"
#include "quorient/messages/name.hpp"
#include "quorient/messages/units.hpp"
#include "quorient/rotation/nearest.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace quorient::cli {

namespace {

struct Mounted {
    std::string name;
    std::optional<Eigen::Matrix3d> rotation;  ///< from the instrument's axes to the body's; nothing: its axes are left-handed
};

std::vector<Mounted> mounted_instruments(const ClusterDescription& cluster)
{
    std::vector<Mounted> all;
    for (std::size_t i = 0; i < cluster.instrument_count; ++i) {
        Eigen::Matrix3d axes;  // columns: where x, y, z point
        Eigen::Index count = 0;
        for (std::size_t axis = 0; axis < cluster.axis_count; ++axis) {
            if (cluster.instrument[axis] != i) continue;
            if (count < 3) axes.col(count) = Eigen::Map<const Eigen::Vector3d>(cluster.axis[axis].data());
            ++count;
        }
        if (count != 3) return {};
        const Eigen::Matrix3d nearest = rotation::nearest_orthogonal(axes);
        all.push_back({std::string(text_of(cluster.instrument_name[i])), nearest.determinant() > 0 ? std::optional(nearest) : std::nullopt});
    }
    return all.size() < 2 ? std::vector<Mounted>{} : all;
}

std::string words_of_mounting(const Mounted& mounted)
{
    if (!mounted.rotation) return "its axes are left-handed: no rotation makes them so";
    const Eigen::Matrix3d& rotation = *mounted.rotation;
    const Eigen::Matrix3d right_angles = rotation.array().round();
    if (!(right_angles * right_angles.transpose()).isIdentity() || right_angles.determinant() < 0) return "turned by " + diagnosis::words_of_turn(rotation);
    const double off_deg = Eigen::AngleAxisd(Eigen::Matrix3d(rotation * right_angles.transpose())).angle() / degree;
    const std::string words = right_angles.isIdentity() ? "parallel to the body's axes" : "turned by " + diagnosis::words_of_turn(right_angles);
    return fmt::format("{}, off by {:.2f} degrees", words, off_deg);
}

Eigen::Quaterniond quaternion_of(const Eigen::Matrix3d& rotation)
{
    Eigen::Quaterniond q(rotation);
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    return q;
}

}  // namespace

std::string mounting_text(const ClusterDescription& cluster)
{
    const auto all = mounted_instruments(cluster);
    if (all.empty()) return {};
    std::string text = "\nmounting in the body frame, and the line for source.imus of a system file\n";
    for (const Mounted& mounted : all) {
        text += fmt::format("  {:<10} {}\n", mounted.name, words_of_mounting(mounted));
        if (!mounted.rotation) continue;
        const auto q = quaternion_of(*mounted.rotation);
        text += fmt::format("  {:<10} rotation: [{:.9f}, {:.9f}, {:.9f}, {:.9f}]\n", "", q.w(), q.x(), q.y(), q.z());
    }
    return text;
}

Json mounting_json(const ClusterDescription& cluster)
{
    Json list = Json::array();
    for (const Mounted& mounted : mounted_instruments(cluster)) {
        Json rotation;
        if (mounted.rotation) {
            const auto q = quaternion_of(*mounted.rotation);
            rotation = Json::array({q.w(), q.x(), q.y(), q.z()});
        }
        list.push_back({{"instrument", mounted.name}, {"rotation", rotation}, {"words", words_of_mounting(mounted)}});
    }
    return list;
}

}  // namespace quorient::cli
