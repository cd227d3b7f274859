# NAME: a policy of usar. It answers a question with groups: for each task, the ids of its robots.
# It needs the package jsonlite.
#
# Rscript NAME.R --test     asks it the questions of NAME.questions.jsonl

library(jsonlite)

# Per role, the robots with more energy take the harder tasks; ties go to the lower id.
decide <- function(question, options) {
  level <- which(vapply(question$levels, function(level) level$name == "energy", logical(1)))
  difficulty <- vapply(question$tasks, function(task) task$difficulty, numeric(1))
  groups <- rep(list(integer(0)), length(question$tasks))
  for (role in seq_along(question$quotas)) {
    size <- unlist(question$quotas[[role]]$members)
    robots <- Filter(function(robot) robot$role == role - 1, question$members)
    id <- vapply(robots, function(robot) as.integer(robot$id), integer(1))
    energy <- vapply(robots, function(robot) as.numeric(c(robot$levels[[level]], 0)[1]), numeric(1))
    ids <- id[order(-energy, id)]
    for (task in order(-difficulty)) {
      groups[[task]] <- c(groups[[task]], head(ids, size[task]))
      ids <- ids[seq_along(ids) > size[task]]
    }
  }
  groups
}

send <- function(message) {
  cat(toJSON(message, auto_unbox = TRUE), "\n", sep = "") # all other prints: message(...)
  flush(stdout())
}

answer <- function() {
  options <- list()
  input <- file("stdin", "r")
  while (length(line <- readLines(input, n = 1)) > 0) {
    message <- fromJSON(line, simplifyVector = FALSE)
    if (message$type == "hello") {
      options <- message$options
      send(list(type = "hello", protocol = 1, schema_version = 3,
                name = "NAME", version = "0.1", deterministic = TRUE))
    } else if (message$type == "question") {
      groups <- decide(message$question, options)
      send(list(type = "decision", id = message$id, decision = list(assignment = list(groups = groups))))
    } else {
      break
    }
  }
}

test <- function() {
  script <- sub("--file=", "", grep("--file=", commandArgs(), value = TRUE))
  lines <- readLines(paste0(sub("[.]R$", "", script), ".questions.jsonl"))
  for (line in lines) {
    question <- fromJSON(line, simplifyVector = FALSE)
    groups <- decide(question, list())
    ids <- vapply(question$members, function(robot) as.integer(robot$id), integer(1))
    stopifnot(length(groups) == length(question$tasks), identical(sort(unlist(groups)), sort(ids)))
  }
  cat(length(lines), "questions answered\n")
}

if ("--test" %in% commandArgs(trailingOnly = TRUE)) test() else answer()
