/* The supervisor with a port that does nothing. It starts in TRIPPED, because the port does not know the reset cause. */
#include <stdio.h>

#include "agv/names.h"
#include "agv/supervisor.h"
#include "hal_template/hal_template.h"

int main(void) {
    static struct hal hal;
    static agv_recorder_t recorder;
    static agv_supervisor_t supervisor;
    const agv_ports_t ports = {.hal = &hal, .recorder = &recorder};
    agv_config_t config;
    agv_config_defaults(&config);
    hal_template_init(&hal);
    agv_supervisor_start(&supervisor, &ports, &config, 0);
    for (uint32_t now_ms = 1; now_ms <= 1000; now_ms++) {
        agv_supervisor_receive_alive(&supervisor);
        agv_supervisor_tick(&supervisor, &ports, now_ms);
    }
    printf("%s\n", agv_state_name(agv_supervisor_state(&supervisor)));
    return 0;
}
