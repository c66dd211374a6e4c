# Seconds of ordinal::clmm for the model and the likelihood ratio test of crates/stats/benches/mixed_model.rs.
suppressMessages(library(ordinal))
d <- read.csv(commandArgs(trailingOnly = TRUE)[1], stringsAsFactors = TRUE)
d$y <- ordered(d$rating)
seconds <- system.time({
  full <- clmm(y ~ method + (1 | person) + (1 | person:method) + (1 | segment) + (1 | segment:method), d)
  reduced <- clmm(y ~ 1 + (1 | person) + (1 | person:method) + (1 | segment) + (1 | segment:method), d)
})[["elapsed"]]
cat(sprintf("{\"seconds\": %g, \"loglik\": %.6f, \"ordinal\": \"%s\"}\n", seconds, as.numeric(logLik(full)),
            packageVersion("ordinal")))
