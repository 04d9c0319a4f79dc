#include "traffic/traffic.h"

json_t *traffic_messages_json(const traffic_t *traffic) {
    (void)traffic;
    return json_array();
}
