# host_sim in a small image. docs/host-sim.md, "Install", says how to run it.
FROM debian:12-slim AS build
COPY . /src
RUN /src/scripts/package

FROM debian:12-slim
COPY --from=build /src/build/package/agv-supervisor_*.deb /tmp/
RUN apt-get update \
    && apt-get install -y --no-install-recommends /tmp/agv-supervisor_*.deb \
    && rm -rf /tmp/*.deb /var/lib/apt/lists/*
RUN useradd --create-home agv
USER agv
WORKDIR /home/agv
ENTRYPOINT ["host_sim"]
CMD ["demo"]
