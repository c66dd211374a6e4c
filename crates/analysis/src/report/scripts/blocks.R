# How surely each person answered, and a category.
of_confidence <- function(test, question, confidence, category) {
  truth <- trials[[paste0(question, ".truth")]]
  answer <- trials[[paste0(question, ".answer")]]
  sure <- number(confidence)
  keep <- !is.na(truth) & !is.na(answer) & !is.na(sure)
  test(person[keep], truth[keep], answer[keep], sure[keep], category)
}

# The trials of a block of a kind; no face that the seed does not give again is among them.
of_block <- function(block) which(trials[["shown.block"]] %in% block)

# The psychometric function of a person; where levels fall they count with a minus.
of_answers_by_level <- function(test, question, block, who, shape, sign, guess) {
  own <- of_block(block)
  own <- own[person[own] == who & trials[["shown.catch"]][own] == "0"]
  level <- sign * as.numeric(trials[["shown.level"]][own])
  right <- as.numeric(trials[[paste0(question, ".right")]][own])
  known <- !is.na(right)
  n <- tapply(right[known], level[known], length)
  fit <- test(as.numeric(names(n)), as.vector(n), as.vector(tapply(right[known], level[known], sum)), guess, NULL, shape)
  fit[["threshold"]] <- sign * fit[["threshold"]]
  fit
}
# Thresholds found above, and given ones where the answers leave the spread open; those that lie within the levels.
of_found <- function(test, of, given, low, high) {
  thresholds <- names_of == "threshold"
  values <- c(found[thresholds][match(of, keys[thresholds])], as.numeric(given))
  test(values[values >= low & values <= high])
}

# Judgements of differences between levels; `second` is the answer that the second pair differs more.
of_judgements <- function(test, question, block, second) {
  own <- of_block(block)
  answer <- trials[[paste0(question, ".answer")]][own]
  levels <- do.call(rbind, lapply(strsplit(trials[["shown.levels"]][own], " ", fixed = TRUE), as.numeric))
  known <- !is.na(answer)
  test(levels[known, , drop = FALSE], as.numeric(answer[known] == second))
}

# How high a unit is at a time: from 0 at its onset to its peak, and back to 0.
height <- function(course, times) {
  step <- function(x, half) {
    y <- pmin(pmax(x, 0), 1)^(log(0.5) / log(half))
    y^3 * (10 + y * (6 * y - 15))
  }
  rise <- step((times - course[1]) / (course[2] - course[1]), course[5])
  fall <- 1 - step((times - course[2]) / (course[3] - course[2]), course[6])
  inside <- times > course[1] & times < course[3]
  course[4] * ifelse(times <= course[2], rise, fall) * inside
}
# Faces drawn at random: what each unit (of 0 bins: its presence, else its height in each time bin) has to do with an
# answer.
of_faces <- function(test, question, block, category, units, bins, duration) {
  own <- of_block(block)
  answer <- trials[[paste0(question, ".answer")]][own]
  own <- own[!is.na(answer)]
  width <- max(bins, 1)
  times <- (seq_len(width) - 0.5) * duration / width
  cells <- matrix(0, length(own), length(units) * width)
  shown <- strsplit(trials[["shown.courses"]][own], ";", fixed = TRUE)
  for (trial in seq_along(own)) for (text in shown[[trial]]) {
    parts <- strsplit(text, " ", fixed = TRUE)[[1]]
    unit <- match(parts[1], units)
    if (is.na(unit)) next
    cells[trial, (unit - 1) * width + seq_len(width)] <- if (bins == 0) 1 else height(as.numeric(parts[-1]), times)
  }
  result <- test(person[own], cells, answer[!is.na(answer)] == category)
  names_of_cells <- paste(rep(units, each = width), seq_len(width), sep = ".")
  unlist(lapply(names(result), function(name) setNames(result[[name]], paste(name, names_of_cells, sep = "."))))
}

# Where a rating that follows the clip stands at an instant (from 1): the mean over people with its t interval.
courses <- list()
course <- function(y) {
  if (is.null(courses[[y]])) {
    courses[[y]] <<- lapply(strsplit(trials[[paste0(y, ".trace")]], " ", fixed = TRUE), as.numeric)
  }
  courses[[y]]
}
of_course <- function(test, matched, y, g, levels, level, instant) {
  v <- vapply(course(y), `[`, 0, instant)
  keep <- !is.na(v) & trials[[g]] %in% level & is_matched(matched, y, g, levels)
  test(as.vector(tapply(v[keep], person[keep], mean)))
}
mean_and_interval <- function(values) {
  n <- length(values)
  reach <- if (n > 1) qt(0.975, n - 1) * sd(values) / sqrt(n) else NA
  c(mean = mean(values), low = mean(values) - reach, high = mean(values) + reach, n = n)
}

# Differences of people's mean courses between two levels, over the instants that everybody has.
mean_courses <- function(matched, y, g, levels, level) {
  own <- which(trials[[g]] %in% level & !is.na(trials[[paste0(y, ".trace")]]) & is_matched(matched, y, g, levels))
  lapply(split(course(y)[own], person[own]), function(all) {
    n <- min(lengths(all))
    colMeans(do.call(rbind, lapply(all, `[`, seq_len(n))))
  })
}
of_courses <- function(test, matched, y, g, levels, a, b) {
  of_a <- mean_courses(matched, y, g, levels, a)
  of_b <- mean_courses(matched, y, g, levels, b)
  people <- intersect(names(of_a), names(of_b))
  n <- min(lengths(of_a[people]), lengths(of_b[people]))
  test(do.call(rbind, lapply(people, function(who) of_a[[who]][seq_len(n)] - of_b[[who]][seq_len(n)])))
}
