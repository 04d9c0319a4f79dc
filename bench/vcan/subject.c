#include "subject.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define NS_PER_S 1000000000u
#define LAST_WORDS_MS 3000

extern char **environ;

bool subject_start(subject_t *subject) {
    posix_spawn_file_actions_t actions;
    int ends[2];
    subject->length = 0;
    subject->state[0] = '\0';
    subject->received = 0;
    if (pipe2(ends, O_CLOEXEC) != 0) {
        perror("pipe");
        return false;
    }
    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    (void)posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    const int error = posix_spawnp(&subject->pid, subject->command[0], &actions, NULL, subject->command, environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    (void)close(ends[1]);
    (void)fcntl(ends[0], F_SETFL, O_NONBLOCK);
    subject->output_fd = ends[0];
    if (error != 0) {
        (void)fprintf(stderr, "bench_vcan_traffic: %s: %s\n", subject->command[0], strerror(error));
        subject->pid = 0;
    }
    return error == 0;
}

static void take_line(subject_t *subject) {
    const char *to = strstr(subject->line, "\"to\": \"");
    const char *received = strstr(subject->line, "\"received\": ");
    if (to != NULL) {
        (void)sscanf(to, "\"to\": \"%15[A-Z]", subject->state);
    }
    if (received != NULL) {
        subject->received = strtoull(received + strlen("\"received\": "), NULL, 10);
        subject->told_received = true;
    }
}

static void take(subject_t *subject, char letter) {
    if (letter == '\n') {
        subject->line[subject->length] = '\0';
        take_line(subject);
        subject->length = 0;
    } else if (subject->length < SUBJECT_LINE_SIZE - 1) {
        subject->line[subject->length] = letter;
        subject->length++;
    }
}

bool subject_listen(subject_t *subject) {
    char text[1024];
    ssize_t count = 0;
    while ((count = read(subject->output_fd, text, sizeof text)) > 0) {
        for (ssize_t i = 0; i < count; i++) {
            take(subject, text[i]);
        }
    }
    return (count < 0) && (errno == EAGAIN);
}

bool subject_is(const subject_t *subject, const char *state) {
    return strcmp(subject->state, state) == 0;
}

void subject_signal(const subject_t *subject, int number) {
    (void)kill(subject->pid, number);
}

void subject_end(subject_t *subject) {
    struct pollfd file = {.fd = subject->output_fd, .events = POLLIN};
    subject_signal(subject, SIGTERM);
    subject_signal(subject, SIGCONT);
    while ((poll(&file, 1, LAST_WORDS_MS) > 0) && subject_listen(subject)) {
    }
    subject_signal(subject, SIGKILL);
    (void)waitpid(subject->pid, NULL, 0);
    (void)close(subject->output_fd);
    subject->pid = 0;
}

uint64_t subject_cpu_ns(const subject_t *subject) {
    char path[64];
    unsigned long user = 0;
    unsigned long system = 0;
    (void)snprintf(path, sizeof path, "/proc/%d/stat", (int)subject->pid);
    FILE *file = fopen(path, "r");
    if (file != NULL) {
        /* the name in parentheses could contain spaces; those of the measured programs do not */
        if (fscanf(file, "%*d %*s %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &system) != 2) {
            user = 0;
            system = 0;
        }
        (void)fclose(file);
    }
    return (uint64_t)(user + system) * (NS_PER_S / (uint64_t)sysconf(_SC_CLK_TCK));
}
