#include "dicom/pacs/detail/storage_service.h"

namespace trocar::dicom::detail {
namespace {

// PS3.4, table B.2-1.
constexpr std::uint16_t kStored = 0x0000;
constexpr std::uint16_t kOutOfResources = 0xa700;

DimseCommand answer_of(const DimseMessage& request, DimseField field, std::uint16_t status) {
  DimseCommand answer;
  answer.field = field;
  answer.sop_class = request.command.sop_class;
  answer.sop_instance = request.command.sop_instance;
  answer.responded_id = request.command.message_id;
  answer.status = status;
  return answer;
}

Status receive_object(Association& sender, const DimseMessage& request, ObjectSink& sink) {
  TROCAR_TRY_STATUS(sink.begin());
  TROCAR_TRY_STATUS(sender.receive_data([&](std::string_view part) { return sink.append(part); }));
  return sink.end(sender.transfer_syntax(request.context));
}

}  // namespace

Status store_object(Association& sender, const DimseMessage& request, ObjectSink& sink) {
  if (request.command.field != DimseField::kStore || !request.command.has_data)
    return fail("the PACS sent a message that is no object", "C-STORE",
                "ask its administrator to check its destination");
  const Status received = receive_object(sender, request, sink);
  const DimseCommand answer = answer_of(request, DimseField::kStoreResponse, received ? kStored : kOutOfResources);
  const Status answered = sender.send(request.context, answer);
  return received ? answered : received;
}

Status answer_echo(Association& sender, const DimseMessage& request) {
  return sender.send(request.context, answer_of(request, DimseField::kEchoResponse, kStored));
}

}  // namespace trocar::dicom::detail
