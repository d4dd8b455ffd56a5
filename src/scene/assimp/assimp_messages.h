// Messages between this process and the one that runs Assimp (src/assimp), over a pair of sockets.
#pragma once

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace radiosity {

enum class AssimpMessage : std::uint8_t {
  read,        ///< to it: the path of the scene
  scene,       ///< from it: the scene (assimp_scene.h)
  cannot_read  ///< from it: Assimp's words
};

/// How it ends if memory is short.
constexpr int kAssimpOutOfMemory = 3;

/// False if the other end is gone.
inline bool sendAll(int socket, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = send(socket, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    size -= std::size_t(sent);
  }
  return true;
}

inline bool receiveAll(int socket, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t received = recv(socket, bytes, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    bytes += received;
    size -= std::size_t(received);
  }
  return true;
}

inline bool sendMessage(int socket, AssimpMessage kind, std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  return sendAll(socket, reinterpret_cast<const char*>(&kind), sizeof(kind)) &&
         sendAll(socket, reinterpret_cast<const char*>(&size), sizeof(size)) &&
         sendAll(socket, bytes.data(), bytes.size());
}

/// Nothing if the other end is gone or the message is longer than `most` bytes. Memory grows with
/// the bytes that arrive, not with those that are announced.
inline std::optional<AssimpMessage> receiveMessage(int socket, std::string& bytes,
                                                   std::uint64_t most) {
  AssimpMessage kind{};
  std::uint64_t size = 0;
  bytes.clear();
  if (!receiveAll(socket, reinterpret_cast<char*>(&kind), sizeof(kind)) ||
      !receiveAll(socket, reinterpret_cast<char*>(&size), sizeof(size)) || size > most) {
    return std::nullopt;
  }
  while (bytes.size() < size) {
    constexpr std::uint64_t kStep = std::uint64_t(1) << 24;
    const std::size_t had = bytes.size();
    bytes.resize(had + std::size_t(std::min(kStep, size - had)));
    if (!receiveAll(socket, bytes.data() + had, bytes.size() - had)) return std::nullopt;
  }
  return kind;
}

}  // namespace radiosity
