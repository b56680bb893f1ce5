#include "io/detail/quiet.h"

#include <gdcmTrace.h>
#include <itkObject.h>
#include <nifti1_io.h>
#include <vtkObject.h>

#include <mutex>

namespace trocar::detail {

void silence_libraries() {
  static std::once_flag once;
  std::call_once(once, [] {
    itk::Object::SetGlobalWarningDisplay(false);
    vtkObject::SetGlobalWarningDisplay(0);
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    nifti_set_debug_level(0);
  });
}

}  // namespace trocar::detail
