#include "sqlite_bag.hpp"

#include "imu_message.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <algorithm>

namespace quorient::recording::ros {

void SqliteBag::Close::operator()(sqlite3* database) const
{
    sqlite3_close(database);
}

void SqliteBag::Close::operator()(sqlite3_stmt* statement) const
{
    sqlite3_finalize(statement);
}

SqliteBag::SqliteBag(Database database, std::string name) : database_(std::move(database)), name_(std::move(name))
{
    format_ = "ROS 2 bag, sqlite3";
}

tl::expected<std::unique_ptr<InstrumentLog>, std::string> SqliteBag::open(const std::filesystem::path& file)
{
    sqlite3* opened = nullptr;
    // A bag may lie where nothing can be written, not even a lock.
    const std::string address = "file:" + std::filesystem::absolute(file).string() + "?immutable=1";
    const int result = sqlite3_open_v2(address.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    Database database(opened);
    if (result != SQLITE_OK) return tl::unexpected(fmt::format("{}: {}", file.string(), sqlite3_errstr(result)));
    std::unique_ptr<SqliteBag> bag(new SqliteBag(std::move(database), file.filename().string()));
    if (const auto problem = bag->prepare()) return tl::unexpected(fmt::format("{}: {}", file.string(), *problem));
    return bag;
}

tl::expected<std::unique_ptr<InstrumentLog>, std::string> SqliteBag::open(std::vector<std::uint8_t> bytes, const std::string& name)
{
    sqlite3* opened = nullptr;
    sqlite3_open_v2(":memory:", &opened, SQLITE_OPEN_READWRITE, nullptr);
    std::unique_ptr<SqliteBag> bag(new SqliteBag(Database(opened), name));
    bag->bytes_ = std::move(bytes);
    const auto size = static_cast<sqlite3_int64>(bag->bytes_.size());
    const int result = sqlite3_deserialize(opened, "main", bag->bytes_.data(), size, size, SQLITE_DESERIALIZE_READONLY);
    if (result != SQLITE_OK) return tl::unexpected(fmt::format("{}: {}", name, sqlite3_errstr(result)));
    if (const auto problem = bag->prepare()) return tl::unexpected(fmt::format("{}: {}", name, *problem));
    return bag;
}

SqliteBag::Statement SqliteBag::statement(const char* text)
{
    sqlite3_stmt* prepared = nullptr;
    sqlite3_prepare_v2(database_.get(), text, -1, &prepared, nullptr);
    return Statement(prepared);
}

/// Finds the topics. @returns why this is no bag of ROS 2
std::optional<std::string> SqliteBag::prepare()
{
    sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    const auto topics = statement("SELECT id, name, type, serialization_format FROM topics");
    messages_ = statement("SELECT id, topic_id, timestamp, data FROM messages");
    if (!topics || !messages_) return fmt::format("a database that is no ROS 2 bag: {}", sqlite3_errmsg(database_.get()));
    while (sqlite3_step(topics.get()) == SQLITE_ROW) {
        const auto text = [&](int column) {
            const auto* const found = sqlite3_column_text(topics.get(), column);
            return found == nullptr ? std::string{} : std::string(reinterpret_cast<const char*>(found));
        };
        if (text(2) == "sensor_msgs/msg/Imu" && text(3) == "cdr") topics_.emplace(sqlite3_column_int64(topics.get(), 0), Topic{text(1), {}});
    }
    const auto last = statement("SELECT max(id) FROM messages");
    if (last && sqlite3_step(last.get()) == SQLITE_ROW) last_ = sqlite3_column_int64(last.get(), 0);
    if (topics_.empty()) return "no topic is a sensor_msgs/msg/Imu";
    return std::nullopt;
}

double SqliteBag::progress() const
{
    return last_ > 0 ? std::clamp(static_cast<double>(row_) / static_cast<double>(last_), 0.0, 1.0) : 1.0;
}

ReadOutcome SqliteBag::next(InstrumentSample& sample)
{
    while (!ended_) {
        const int result = sqlite3_step(messages_.get());
        if (result != SQLITE_ROW) {
            ended_ = true;
            if (result == SQLITE_DONE) break;
            ++statistics_.records;
            ++statistics_.malformed;
            return refuse(fmt::format("the database is damaged: {}", sqlite3_errmsg(database_.get())));
        }
        row_ = sqlite3_column_int64(messages_.get(), 0);
        const auto found = topics_.find(sqlite3_column_int64(messages_.get(), 1));
        if (found == topics_.end()) continue;
        Topic& topic = found->second;
        ++statistics_.records;
        const auto* const data = static_cast<const std::uint8_t*>(sqlite3_column_blob(messages_.get(), 3));
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(messages_.get(), 3));
        const auto message = parse_stored_imu(data == nullptr ? Bytes{} : Bytes(data, size));
        if (!topic.place) topic.place = place_of(instrument_of(topic.name));
        if (!message || !topic.place) {
            ++statistics_.malformed;
            return refuse(message ? fmt::format("{}: more than {} instruments", topic.name, max_instruments)
                                  : fmt::format("{}: not a sensor_msgs/Imu", topic.name));
        }
        constexpr std::int64_t longest_ns = std::int64_t{1} << 62U;
        const auto made = sample_of(*message, std::clamp<std::int64_t>(sqlite3_column_int64(messages_.get(), 2), -longest_ns, longest_ns));
        if (!made) {
            ++statistics_.incomplete;
            continue;
        }
        sample = *made;
        sample.instrument = *topic.place;
        sample.position = static_cast<std::uint64_t>(row_);
        ++statistics_.frames;
        return ReadOutcome::frame;
    }
    return ReadOutcome::end;
}

ReadOutcome SqliteBag::refuse(std::string_view why)
{
    problem_ = fmt::format("{}: message {}: {}", name_, row_, why);
    return ReadOutcome::rejected;
}

}  // namespace quorient::recording::ros
