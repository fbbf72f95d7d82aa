#pragma once

#include "mcap_writer.hpp"

#include <sqlite3.h>
#include <filesystem>

namespace quorient::recording::test {

/// Writes ROS 2 bags of sqlite3, as rosbag2 does.
class SqliteBagWriter {
public:
    explicit SqliteBagWriter(const std::string& file = ":memory:")
    {
        sqlite3_open(file.c_str(), &database_);
        run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, "
            "offered_qos_profiles TEXT NOT NULL)");
        run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
        run("BEGIN");
    }
    ~SqliteBagWriter()
    {
        run("COMMIT");
        sqlite3_close(database_);
    }
    SqliteBagWriter(const SqliteBagWriter&) = delete;
    SqliteBagWriter& operator=(const SqliteBagWriter&) = delete;

    void topic(int id, const std::string& name, const std::string& type)
    {
        run("INSERT INTO topics VALUES(" + std::to_string(id) + ", '" + name + "', '" + type + "', 'cdr', '')");
    }

    void message(int topic, std::int64_t stored_ns, const ByteVector& data)
    {
        sqlite3_stmt* statement = nullptr;
        sqlite3_prepare_v2(database_, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1, &statement, nullptr);
        sqlite3_bind_int(statement, 1, topic);
        sqlite3_bind_int64(statement, 2, stored_ns);
        sqlite3_bind_blob(statement, 3, data.data(), static_cast<int>(data.size()), SQLITE_TRANSIENT);
        sqlite3_step(statement);
        sqlite3_finalize(statement);
    }

    /// The file as bytes.
    ByteVector bytes()
    {
        run("COMMIT");
        sqlite3_int64 size = 0;
        unsigned char* const serialized = sqlite3_serialize(database_, "main", &size, 0);
        ByteVector result(serialized, serialized + size);
        sqlite3_free(serialized);
        return result;
    }

private:
    void run(const std::string& statement) { sqlite3_exec(database_, statement.c_str(), nullptr, nullptr, nullptr); }

    sqlite3* database_ = nullptr;
};

inline ByteVector sqlite_bag_of_two_imus(std::size_t rows)
{
    SqliteBagWriter bag;
    bag.topic(1, "/imu/left", "sensor_msgs/msg/Imu");
    bag.topic(2, "/camera", "sensor_msgs/msg/Image");
    bag.topic(3, "/imu/right", "sensor_msgs/msg/Imu");
    for (std::size_t row = 0; row < rows; ++row) {
        const auto nanoseconds = static_cast<std::uint32_t>(10'000'000 * row);
        bag.message(1, 1, cdr_imu(100, nanoseconds, {0.01 * static_cast<double>(row), 0, 0}));
        bag.message(2, 2, ByteVector(300, 0x55));
        bag.message(3, 3, cdr_imu(100, nanoseconds, {0, 0.5, 0}, "frame", false));
    }
    return bag.bytes();
}

}  // namespace quorient::recording::test
