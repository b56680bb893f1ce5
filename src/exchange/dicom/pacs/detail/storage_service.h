#pragma once

#include "dicom/pacs/detail/association.h"

namespace trocar::dicom::detail {

/// Receives the object of a C-STORE request, passes it to `sink` and answers. Errors: those of the connection and of
/// the sink (the sender is told), another message than C-STORE.
Status store_object(Association& sender, const DimseMessage& request, ObjectSink& sink);

/// Answers C-ECHO, with which administrators test an entry of the PACS.
Status answer_echo(Association& sender, const DimseMessage& request);

}  // namespace trocar::dicom::detail
