// ROS 2 recordings as .mcap (mcap.dev/spec): records of an opcode, a length and content. Messages,
// schemas and channels are usually in chunks, which may be compressed. The index at the end is not
// used, so a recording that was cut off can be read.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "recordings/chunk_store.h"
#include "recordings/message_file.h"

namespace tessera {
namespace {

constexpr std::uint8_t kMcapMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::uint64_t kMostRecordBytes = 16 << 20;  // of what is no message and no chunk

enum McapOpcode : std::uint8_t {
    kSchema = 3,
    kChannel = 4,
    kMessage = 5,
    kChunk = 6,
    kDataEnd = 15
};

// Reads the fields of a record. After the first that is not there, all are zero.
class McapFields {
  public:
    explicit McapFields(ByteView bytes) : bytes_(bytes) {}

    template <class T>
    T Get() {
        T value{};
        if (bytes_.size() < sizeof(T)) {
            ok_ = false;
            return value;
        }
        std::memcpy(&value, bytes_.data(), sizeof(T));
        bytes_ = bytes_.subspan(sizeof(T));
        return value;
    }
    std::string Text() {
        const auto size = Get<std::uint32_t>();
        if (size > bytes_.size()) ok_ = false;
        if (!ok_) return {};
        const std::string text(bytes_.begin(), bytes_.begin() + size);
        bytes_ = bytes_.subspan(size);
        return text;
    }
    std::size_t left() const { return bytes_.size(); }
    bool ok() const { return ok_; }

  private:
    ByteView bytes_;
    bool ok_ = true;
};

class McapFile : public MessageFile {
  public:
    explicit McapFile(InputFile file) : store_(std::move(file)) {
        whole_.bytes = whole_.stored_bytes = store_.file().size();
    }

    Status ForEach(const Take& take) override {
        std::uint64_t at = sizeof(kMcapMagic);
        return Walk(whole_, at, true, take);
    }

    Status Read(const MessagePlace& place, std::vector<std::uint8_t>& bytes) override {
        bytes.resize(static_cast<std::size_t>(place.bytes));
        return store_.Read(ChunkAt(chunks_, place.chunk, whole_), place.offset, bytes);
    }

  private:
    static constexpr std::size_t kRecordHead = 9;    // opcode and length
    static constexpr std::size_t kMessageHead = 22;  // before a message's data
    static constexpr std::size_t kLogTime = 6;       // in a message's head

    Status Walk(const Chunk& chunk, std::uint64_t at, bool outside, const Take& take) {
        while (at < chunk.bytes) {
            std::uint8_t head[kRecordHead];
            if (Status status = store_.Read(chunk, at, head); !status.ok()) return status;
            at += kRecordHead;
            std::uint64_t size;
            std::memcpy(&size, head + 1, sizeof(size));
            if (size > chunk.bytes - at) return Status::Error("the file ends within a record");
            if (outside && head[0] == kDataEnd) return {};
            Status status = outside && head[0] == kChunk
                                ? WalkChunk(at, size, take)
                                : TakeRecord(head[0], chunk, at, size, take);
            if (!status.ok()) return status;
            at += size;
        }
        return {};
    }

    Status WalkChunk(std::uint64_t at, std::uint64_t size, const Take& take) {
        constexpr std::size_t kMostHead = 64;  // the compression's name is a short word
        std::uint8_t head[kMostHead]{};
        const std::size_t read = std::min<std::uint64_t>(size, kMostHead);
        if (Status status = store_.Read(whole_, at, std::span(head).first(read)); !status.ok())
            return status;
        McapFields fields(ByteView(head, read));
        fields.Get<std::uint64_t>();  // first and last time
        fields.Get<std::uint64_t>();
        Chunk chunk;
        chunk.bytes = fields.Get<std::uint64_t>();
        fields.Get<std::uint32_t>();  // checksum
        const auto compression = ChunkCompressionOf(fields.Text());
        chunk.stored_bytes = fields.Get<std::uint64_t>();
        const std::size_t head_bytes = read - fields.left();
        if (!fields.ok() || !compression || chunk.stored_bytes > size - head_bytes)
            return Status::Error("a chunk is damaged, or in an unknown compression");
        chunk.compression = *compression;
        chunk.offset = at + head_bytes;
        if (*compression == ChunkCompression::kNone) chunk.bytes = chunk.stored_bytes;
        chunks_.push_back(chunk);
        return Walk(chunk, 0, false, take);
    }

    Status TakeRecord(std::uint8_t opcode, const Chunk& chunk, std::uint64_t at, std::uint64_t size,
                      const Take& take) {
        if (opcode == kMessage) return TakeMessage(chunk, at, size, take);
        if (opcode != kSchema && opcode != kChannel) return {};
        if (size > kMostRecordBytes) return Status::Error("a record is too long");
        record_.resize(static_cast<std::size_t>(size));
        if (Status status = store_.Read(chunk, at, record_); !status.ok()) return status;
        McapFields fields(record_);
        const auto id = fields.Get<std::uint16_t>();
        if (opcode == kSchema) {
            schemas_[id] = RosTypeOf(fields.Text());
        } else {
            const std::string type = schemas_[fields.Get<std::uint16_t>()];
            const std::string name = fields.Text();
            topics_.try_emplace(id, MessageTopic{name, type,
                                                 fields.Text() == "ros1" ? RosSerialisation::kRos1
                                                                         : RosSerialisation::kCdr});
        }
        return fields.ok() ? Status::Ok() : Status::Error("a record is damaged");
    }

    Status TakeMessage(const Chunk& chunk, std::uint64_t at, std::uint64_t size, const Take& take) {
        if (size < kMessageHead || size > kMostMessageBytes)
            return Status::Error("a message is too short or too long");
        head_.resize(
            static_cast<std::size_t>(std::min<std::uint64_t>(size, kMessageHead + kHeadBytes)));
        if (Status status = store_.Read(chunk, at, head_); !status.ok()) return status;
        std::uint16_t channel;
        std::memcpy(&channel, head_.data(), sizeof(channel));
        const auto topic = topics_.find(channel);
        if (topic == topics_.end()) return {};
        std::uint64_t received_ns;
        std::memcpy(&received_ns, head_.data() + kLogTime, sizeof(received_ns));
        take(topic->second,
             {chunk.offset, at + kMessageHead, size - kMessageHead,
              1e-9 * static_cast<double>(received_ns)},
             std::span(head_).subspan(kMessageHead));
        return {};
    }

    ChunkStore store_;
    Chunk whole_;
    std::vector<Chunk> chunks_;
    std::map<std::uint16_t, std::string> schemas_;
    std::map<std::uint16_t, MessageTopic> topics_;
    std::vector<std::uint8_t> record_, head_;
};

}  // namespace

MessageFileResult OpenMcapFile(const std::string& path) {
    Result<InputFile> file = InputFile::Open(path);
    if (!file.ok()) return file.status();
    std::uint8_t magic[sizeof(kMcapMagic)]{};
    const Status read = file.value().ReadAt(0, magic);
    if (!read.ok() || std::memcmp(magic, kMcapMagic, sizeof(magic)) != 0)
        return Status::Error(path + ": is not an .mcap file");
    return std::unique_ptr<MessageFile>(std::make_unique<McapFile>(std::move(file.value())));
}

}  // namespace tessera
