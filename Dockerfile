# One image for every part of Weaver Console; docker-compose.yml says which command each service runs.
FROM node:20-bookworm-slim AS page
WORKDIR /page
COPY web/package.json web/package-lock.json ./
RUN npm ci --no-audit --no-fund
COPY web ./
RUN npm run build

FROM python:3.11-slim-bookworm
RUN apt-get update \
    && apt-get install --yes --no-install-recommends libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /build
COPY constraints.txt pyproject.toml setup.py README.md ./
COPY shared shared
COPY robot_agent robot_agent
COPY sim_agent sim_agent
COPY weaver_console weaver_console
COPY --from=page /page/dist web/dist
RUN pip install --no-cache-dir -c constraints.txt ".[robot,sim,console]"
# Away from the sources, so that what runs is what was installed.
WORKDIR /var/lib/weaver
RUN weaver warm-up
ENTRYPOINT ["weaver"]
CMD ["--help"]
