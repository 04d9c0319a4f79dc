#include "io/events.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "common/crash.h"
