# docker build -t tessera . && docker run --rm -v "$PWD:/data" tessera run /data/recording --out /data/scan
FROM debian:12
WORKDIR /tessera
COPY . .
RUN ./run build
WORKDIR /data
ENTRYPOINT ["/tessera/build/release/apps/tessera"]
