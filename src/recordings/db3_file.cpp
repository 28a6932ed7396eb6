// ROS 2 recordings as .db3: an SQLite database with the tables topics and messages.
#include <fmt/format.h>
#include <sqlite3.h>

#include <map>

#include "core/input_file.h"
#include "recordings/message_file.h"

namespace tessera {
namespace {

struct CloseSqlite {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Db3Statement = std::unique_ptr<sqlite3_stmt, CloseSqlite>;

std::string Db3Text(sqlite3_stmt* row, int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
    return text == nullptr ? std::string() : std::string(text);
}

ByteView Db3Blob(sqlite3_stmt* row, int column) {
    const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(row, column));
    return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
}

class Db3File : public MessageFile {
  public:
    explicit Db3File(sqlite3* database) : database_(database) {
        sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostMessageBytes));
    }

    Status ReadTopics() {
        Db3Statement rows = Prepare("SELECT id, name, type, serialization_format FROM topics");
        if (!rows) return Failed();
        int state;
        while ((state = sqlite3_step(rows.get())) == SQLITE_ROW) {
            if (Db3Text(rows.get(), 3) != "cdr") continue;
            topics_[sqlite3_column_int64(rows.get(), 0)] = MessageTopic{
                Db3Text(rows.get(), 1), RosTypeOf(Db3Text(rows.get(), 2)), RosSerialisation::kCdr};
        }
        return state == SQLITE_DONE ? Status::Ok() : Failed();
    }

    Status ForEach(const Take& take) override {
        Db3Statement rows = Prepare(
            fmt::format(
                "SELECT id, topic_id, length(data), substr(data, 1, {}), timestamp FROM messages "
                "ORDER BY timestamp",
                kHeadBytes)
                .c_str());
        if (!rows) return Failed();
        int state;
        while ((state = sqlite3_step(rows.get())) == SQLITE_ROW) {
            const auto topic = topics_.find(sqlite3_column_int64(rows.get(), 1));
            if (topic == topics_.end()) continue;
            const auto id = static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 0));
            const auto bytes = static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 2));
            const auto received_ns = static_cast<double>(sqlite3_column_int64(rows.get(), 4));
            take(topic->second, {0, id, bytes, 1e-9 * received_ns}, Db3Blob(rows.get(), 3));
        }
        return state == SQLITE_DONE ? Status::Ok() : Failed();
    }

    Status Read(const MessagePlace& place, std::vector<std::uint8_t>& bytes) override {
        if (!read_) read_ = Prepare("SELECT data FROM messages WHERE id = ?");
        if (!read_) return Failed();
        sqlite3_reset(read_.get());
        sqlite3_bind_int64(read_.get(), 1, static_cast<sqlite3_int64>(place.offset));
        if (sqlite3_step(read_.get()) != SQLITE_ROW) return Failed();
        const ByteView data = Db3Blob(read_.get(), 0);
        bytes.assign(data.begin(), data.end());
        sqlite3_reset(read_.get());
        return {};
    }

  private:
    Db3Statement Prepare(const char* sql) {
        sqlite3_stmt* statement = nullptr;
        sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr);
        return Db3Statement(statement);
    }
    Status Failed() const { return Status::Error(sqlite3_errmsg(database_.get())); }

    std::unique_ptr<sqlite3, CloseSqlite> database_;
    std::map<std::int64_t, MessageTopic> topics_;
    Db3Statement read_;
};

}  // namespace

MessageFileResult OpenDb3File(const std::string& path) {
    // SQLite would wait for a pipe, and make a file that is not there.
    if (Result<InputFile> file = InputFile::Open(path); !file.ok()) return file.status();
    sqlite3* database = nullptr;
    const int state = sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
    auto file = std::make_unique<Db3File>(database);
    Status status = state == SQLITE_OK ? file->ReadTopics() : Status::Error(sqlite3_errstr(state));
    if (!status.ok()) return Status::Error(path + ": is no ROS 2 recording: " + status.message());
    return std::unique_ptr<MessageFile>(std::move(file));
}

}  // namespace tessera
