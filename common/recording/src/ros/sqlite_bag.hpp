#pragma once

#include "quorient/recording/instrument_log.hpp"

#include <map>

struct sqlite3;
struct sqlite3_stmt;

namespace quorient::recording::ros {

/// sensor_msgs/Imu of any topic in a ROS 2 bag of sqlite3.
class SqliteBag final : public InstrumentLog {
public:
    static tl::expected<std::unique_ptr<InstrumentLog>, std::string> open(const std::filesystem::path& file);
    static tl::expected<std::unique_ptr<InstrumentLog>, std::string> open(std::vector<std::uint8_t> bytes, const std::string& name);

    ReadOutcome next(InstrumentSample& sample) override;
    double progress() const override;

private:
    struct Close {
        void operator()(sqlite3* database) const;
        void operator()(sqlite3_stmt* statement) const;
    };
    using Database = std::unique_ptr<sqlite3, Close>;
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;

    /// A topic of sensor_msgs/Imu.
    struct Topic {
        std::string name;
        std::optional<std::size_t> place;  // its instrument's
    };

    SqliteBag(Database database, std::string name);
    std::optional<std::string> prepare();
    Statement statement(const char* text);
    ReadOutcome refuse(std::string_view why);

    std::vector<std::uint8_t> bytes_;  // the bag, where it is in memory
    Database database_;
    Statement messages_;
    std::string name_;
    std::map<std::int64_t, Topic> topics_;
    std::int64_t row_ = 0;   // id of the message in hand
    std::int64_t last_ = 0;  // id of the last one
    bool ended_ = false;
};

}  // namespace quorient::recording::ros
