// ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0): records of a header, which is a list of
// name=value fields, and data. Messages and connections are usually in chunks, which may be
// compressed. The index at the end is not used, so a bag that was cut off can be read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "recordings/chunk_store.h"
#include "recordings/message_file.h"

namespace tessera {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kMostHeaderBytes = 1 << 20;

enum BagRecordKind : std::uint8_t { kMessageRecord = 2, kChunkRecord = 5, kConnectionRecord = 7 };

// The fields of a record's header. Views into its bytes.
class BagFields {
  public:
    // False if a field is longer than the header.
    bool Parse(ByteView header) {
        fields_.clear();
        while (!header.empty()) {
            std::uint32_t size = 0;
            if (header.size() < sizeof(size)) return false;
            std::memcpy(&size, header.data(), sizeof(size));
            header = header.subspan(sizeof(size));
            if (size > header.size()) return false;
            const std::string_view field(reinterpret_cast<const char*>(header.data()), size);
            const std::size_t equals = field.find('=');
            if (equals == std::string_view::npos) return false;
            fields_[field.substr(0, equals)] = field.substr(equals + 1);
            header = header.subspan(size);
        }
        return true;
    }
    std::string_view Text(std::string_view name) const {
        const auto found = fields_.find(name);
        return found == fields_.end() ? std::string_view() : found->second;
    }
    template <class T>
    std::optional<T> Number(std::string_view name) const {
        const std::string_view bytes = Text(name);
        if (bytes.size() != sizeof(T)) return std::nullopt;
        T value;
        std::memcpy(&value, bytes.data(), sizeof(T));
        return value;
    }

  private:
    std::map<std::string_view, std::string_view> fields_;
};

struct BagRecord {
    std::vector<std::uint8_t> header;
    BagFields fields;
    std::uint64_t data = 0, data_bytes = 0;  // where its data is, and how much
};

class BagFile : public MessageFile {
  public:
    explicit BagFile(InputFile file) : store_(std::move(file)) {
        whole_.bytes = whole_.stored_bytes = store_.file().size();
    }

    Status ForEach(const Take& take) override {
        std::uint64_t at = kBagMagic.size();
        while (at < whole_.bytes) {
            if (Status status = ReadRecord(whole_, at); !status.ok()) return status;
            const auto kind = record_.fields.Number<std::uint8_t>("op");
            if (kind == kChunkRecord) {
                if (Status status = WalkChunk(take); !status.ok()) return status;
            } else if (Status status = TakeRecord(whole_, take); !status.ok()) {
                return status;
            }
        }
        return {};
    }

    Status Read(const MessagePlace& place, std::vector<std::uint8_t>& bytes) override {
        bytes.resize(static_cast<std::size_t>(place.bytes));
        return store_.Read(ChunkAt(chunks_, place.chunk, whole_), place.offset, bytes);
    }

  private:
    // Leaves `at` after the record.
    Status ReadRecord(const Chunk& chunk, std::uint64_t& at) {
        std::uint32_t size = 0;
        if (Status status = ReadSize(chunk, at, size); !status.ok()) return status;
        if (size > kMostHeaderBytes) return Status::Error("a record's header is too long");
        record_.header.resize(size);
        if (Status status = store_.Read(chunk, at, record_.header); !status.ok()) return status;
        at += size;
        if (!record_.fields.Parse(record_.header))
            return Status::Error("a record's header is damaged");
        if (Status status = ReadSize(chunk, at, size); !status.ok()) return status;
        if (size > chunk.bytes - at) return Status::Error("the file ends within a record");
        record_.data = at;
        record_.data_bytes = size;
        at += size;
        return {};
    }
    Status ReadSize(const Chunk& chunk, std::uint64_t& at, std::uint32_t& size) {
        std::uint8_t raw[sizeof(size)];
        Status status = store_.Read(chunk, at, raw);
        std::memcpy(&size, raw, sizeof(size));
        at += sizeof(size);
        return status;
    }

    Status WalkChunk(const Take& take) {
        Chunk chunk;
        chunk.offset = record_.data;
        chunk.stored_bytes = record_.data_bytes;
        const auto compression = ChunkCompressionOf(record_.fields.Text("compression"));
        if (!compression) return Status::Error("chunks in an unknown compression");
        chunk.compression = *compression;
        chunk.bytes = *compression == ChunkCompression::kNone
                          ? chunk.stored_bytes
                          : record_.fields.Number<std::uint32_t>("size").value_or(0);
        chunks_.push_back(chunk);
        for (std::uint64_t at = 0; at < chunk.bytes;) {
            if (Status status = ReadRecord(chunk, at); !status.ok()) return status;
            if (Status status = TakeRecord(chunk, take); !status.ok()) return status;
        }
        return {};
    }

    // A message or a connection; others are passed over.
    Status TakeRecord(const Chunk& chunk, const Take& take) {
        const auto kind = record_.fields.Number<std::uint8_t>("op");
        const auto connection = record_.fields.Number<std::uint32_t>("conn");
        if (!connection) return {};
        if (kind == kConnectionRecord) return TakeConnection(chunk, *connection);
        const auto topic = topics_.find(*connection);
        if (kind != kMessageRecord || topic == topics_.end()) return {};
        if (record_.data_bytes > kMostMessageBytes) return Status::Error("a message is too long");
        head_.resize(
            static_cast<std::size_t>(std::min<std::uint64_t>(kHeadBytes, record_.data_bytes)));
        if (Status status = store_.Read(chunk, record_.data, head_); !status.ok()) return status;
        // Seconds, then nanoseconds.
        const auto time = record_.fields.Number<std::array<std::uint32_t, 2>>("time");
        const double received_s = time ? (*time)[0] + 1e-9 * (*time)[1] : 0;
        take(topic->second, {chunk.offset, record_.data, record_.data_bytes, received_s}, head_);
        return {};
    }

    Status TakeConnection(const Chunk& chunk, std::uint32_t connection) {
        if (record_.data_bytes > kMostHeaderBytes)
            return Status::Error("a connection's description is too long");
        std::vector<std::uint8_t> data(static_cast<std::size_t>(record_.data_bytes));
        if (Status status = store_.Read(chunk, record_.data, data); !status.ok()) return status;
        BagFields fields;
        if (!fields.Parse(data)) return Status::Error("a connection's description is damaged");
        topics_.try_emplace(
            connection, MessageTopic{std::string(record_.fields.Text("topic")),
                                     std::string(fields.Text("type")), RosSerialisation::kRos1});
        return {};
    }

    ChunkStore store_;
    Chunk whole_;
    std::vector<Chunk> chunks_;
    std::map<std::uint32_t, MessageTopic> topics_;
    BagRecord record_;
    std::vector<std::uint8_t> head_;
};

}  // namespace

MessageFileResult OpenBagFile(const std::string& path) {
    Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    std::uint8_t magic[kBagMagic.size()]{};
    const Status read = file.value().ReadAt(0, magic);
    if (!read.ok() || std::memcmp(magic, kBagMagic.data(), kBagMagic.size()) != 0)
        return Status::Error(path +
                             ": is no ROS 1 bag of format 2.0 (rosbag fix makes one of an "
                             "older bag)");
    return std::unique_ptr<MessageFile>(std::make_unique<BagFile>(std::move(file.value())));
}

}  // namespace tessera
