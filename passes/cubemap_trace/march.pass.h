/* The slides' march through distance cube maps. */
PASS("March along the chain", "000, Cube-map tracing pseudo-code")
#include "slot.h"
#include "march_rows.h"
#line 302
OPTIONAL_READ(utextureBuffer, cubemap_list, R32UI, LIST, 0xFFFFFFFFu)
DISPATCH_LIST(cubemap_list)
ALONG_RAYS(cocoon_distance, normal_jittered)
ALONG_RAYS(cocoon, normal_jittered)
