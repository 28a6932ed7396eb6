// Frames from another program, in any language: pipe:- reads standard input, pipe:PATH makes a Unix
// socket. docs/camera.md describes the stream: "TESSERA1", a camera file, and frames as .klg logs
// store them.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/status.h"
#include "io/byte_stream.h"
#include "io/folder_source.h"
#include "io/frame_source.h"

namespace tessera {

inline constexpr const char* kPipePrefix = "pipe:";
// For the first sender.
inline constexpr double kLongestWait_s = 60;

// `name`: "pipe:-" or "pipe:PATH". Waits for the first sender's camera, at most `longest_wait_s`,
// or until `stop`, if given, is set; both are errors. When a sender at a socket goes, the source
// waits for the next one, whose camera must be the same; standard input ends. A frame that cannot
// be decoded returns kSkip; a stream that is none ends, or at a socket the sender is left. Errors
// name the source and what is wrong.
Result<std::unique_ptr<FrameSource>> OpenPipeSource(const std::string& name,
                                                    const FolderSourceConfig& config,
                                                    double longest_wait_s = kLongestWait_s,
                                                    const std::atomic<bool>* stop = nullptr);
// The same from a stream that is open.
Result<std::unique_ptr<FrameSource>> OpenPipeSource(const std::string& name, ByteStream stream,
                                                    const FolderSourceConfig& config,
                                                    double longest_wait_s,
                                                    const std::atomic<bool>* stop = nullptr);

}  // namespace tessera
