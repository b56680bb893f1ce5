#pragma once

#include <memory>
#include <set>
#include <string>
#include <thread>

#include "core/result.h"
#include "link/detail/zmq_handles.h"

namespace trocar::detail {

/// Answers a context's questions whether a client with a CURVE key may connect (ZeroMQ RFC 27), in a thread of its own.
/// Shuts the context down at its end.
class AllowedClients {
 public:
  static Result<std::unique_ptr<AllowedClients>> start(ZmqContext& context, std::set<std::string> keys);
  ~AllowedClients();
  AllowedClients(const AllowedClients&) = delete;
  AllowedClients& operator=(const AllowedClients&) = delete;

 private:
  AllowedClients(ZmqContext& context, std::set<std::string> keys) : context_(context), keys_(std::move(keys)) {}
  void answer(ZmqSocket& questions) const;

  ZmqContext& context_;
  std::set<std::string> keys_;
  std::thread thread_;
};

}  // namespace trocar::detail
